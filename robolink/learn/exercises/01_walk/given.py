import math


class Walk:
    def __init__(self):
        self.x, self.y = 0.0, 0.0
        self.history = [(self.x, self.y)]

    def step(self, direction, length=0.3):
        # {degrees}
        self.x += length * math.cos(direction)
        self.y += length * math.sin(direction)
        self.history.append((self.x, self.y))


def square(walk):
    # {sides}
    for direction in (0, 90):
        for _ in range(5):
            walk.step(direction)


if __name__ == "__main__":
    walk = Walk()
    square(walk)
    print(walk.history)
