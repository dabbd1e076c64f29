

import numpy as np

from robolink.image import to_array, to_message


class Publisher:
    def publish(self, sent):
        image = to_array(sent)
        assert (image.shape, sent.encoding) == ((4, 20, 3), "bgr8")
        assert image[0, 0].tolist() in ([0, 0, 255], [0, 0, 0])
        print("published")


publisher = Publisher()
on_image(to_message(np.zeros((4, 20, 3), np.uint8), "rgb8"))
