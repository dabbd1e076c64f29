import random

DOORS = [1.0, 2.5, 6.0]


def move(particles, metres):
    # {move}
    return particles


def weigh(particles, sees_door):
    # {weigh}
    return [1.0 for x in particles]


def resample(particles, weights):
    # {resample}
    return particles


if __name__ == "__main__":
    guesses = [random.uniform(0.0, 10.0) for _ in range(1000)]
    for sees_door in (True, False, False, True, False):
        guesses = move(guesses, 0.5)
        guesses = resample(guesses, weigh(guesses, sees_door))
        print(f"{sum(guesses) / len(guesses):.2f}")
