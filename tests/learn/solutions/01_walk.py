import math


class Walk:
    def __init__(self):
        self.x, self.y = 0.0, 0.0
        self.history = [(self.x, self.y)]

    def step(self, direction, length=0.3):
        self.x += length * math.cos(math.radians(direction))
        self.y += length * math.sin(math.radians(direction))
        self.history.append((self.x, self.y))


def square(walk):
    for direction in (0, 90, 180, 270):
        for _ in range(5):
            walk.step(direction)


if __name__ == "__main__":
    walk = Walk()
    square(walk)
    print(walk.history)
