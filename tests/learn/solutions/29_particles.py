import random

DOORS = [1.0, 2.5, 6.0]


def move(particles, metres):
    return [x + random.gauss(metres, 0.05) for x in particles]


def weigh(particles, sees_door):
    weights = []
    for x in particles:
        beside = any(abs(x - door) < 0.3 for door in DOORS)
        weights.append(0.9 if beside == sees_door else 0.1)
    return weights


def resample(particles, weights):
    return random.choices(particles, weights, k=len(particles))


if __name__ == "__main__":
    guesses = [random.uniform(0.0, 10.0) for _ in range(1000)]
    for sees_door in (True, False, False, True, False):
        guesses = move(guesses, 0.5)
        guesses = resample(guesses, weigh(guesses, sees_door))
        print(f"{sum(guesses) / len(guesses):.2f}")
