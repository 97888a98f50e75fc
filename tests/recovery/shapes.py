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
