
assert (image.shape, depths.shape) == ((240, 320, 3), (240, 320))
