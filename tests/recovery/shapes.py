"""Shapes that no catalogue has in this form. Arrays in, arrays out, of size about one."""
import numpy as np


def slow(t, fast_share, fast, late):
    """Warming up with two time constants."""
    return fast_share * -np.expm1(-t / fast) + (1 - fast_share) * -np.expm1(-t / late)


def hysteresis(direction, travel, width):
    """A joint that takes up its play smoothly over some travel after the reversal."""
    return direction * np.tanh(travel / width)


def bump(x, centre, width):
    return np.exp(-0.5 * ((x - centre) / width) ** 2)


def jump(x, at, width):
    return 0.5 * (1 + np.tanh((x - at) / width))


def unit(x):
    """Onto [-1, 1]."""
    low, high = np.min(x), np.max(x)
    return (2 * x - low - high) / (high - low) if high > low else np.zeros_like(x)


# What may go on during a measurement: (design, rng) -> one value a reading.

def gaining(d, rng):
    """An approach that is still gaining on its feed: the last per cents come with the travel."""
    return 1 - 0.03 * rng.random(d.readings)


def warming(d, rng):
    return slow(d.time / 60, rng.uniform(0.3, 0.7), rng.uniform(20, 40), rng.uniform(90, 200))


def drift(d, rng):
    """One an hour, slackening a little."""
    hours = d.time / 3600
    return hours * (1 - 0.02 * hours)


def room(d, rng):
    return unit(d.value("temperature"))


def wave(d, rng):
    return np.sin(2.2 * np.pi * room(d, rng) + rng.uniform(0, 6))


def passing(shortest, longest):
    """Something came and went on the day, in so many seconds."""
    def of(d, rng):
        day = d.time[d.training()]
        return bump(d.time, rng.uniform(np.quantile(day, 0.25), np.quantile(day, 0.75)), rng.uniform(shortest, longest))
    return of


def giving_way(d, rng):
    """Something gave way in the middle of a set-up."""
    block = rng.choice(sorted(set(d.block()[d.training()])))
    return jump(d.time, np.median(d.time[d.block() == block]), 60)


def cubic(condition):
    """Chebyshev's, of the condition's logarithm."""
    def of(d, rng):
        x = unit(np.log(d.value(condition)))
        return 4 * x**3 - 3 * x
    return of


def room_by_feed(d, rng):
    return room(d, rng) * unit(np.log(d.value("feed")))


def along(*share):
    """Moves the indications by these shares of a profile: (design, rng) -> (n, number of indications)."""
    return lambda profile: lambda d, rng: profile(d, rng)[:, None] * np.array(share)
