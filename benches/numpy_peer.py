"""The cases of distances.rs as one would write them in NumPy today: one process, whole arrays at a time.

    python3 benches/numpy_peer.py

prints, per case, the best of several runs in microseconds and the number that `cargo bench` prints too.
"""

import time

import numpy as np

SECOND_RADIATION_CM_K = 1.438776877503934  # hc/k
PREFACTOR = 2.0 * 2.99792458e8 * 1e6  # 2c in photons s^-1 m^-2 sr^-1 per cm^-1, wavenumbers in cm^-1

nu = 715.0 + np.arange(536)
skin = np.full_like(nu, 0.95)
robot = np.polynomial.Polynomial([0.49287, -0.0782, 0.00892])((nu - 985.0) / 265.0)
surroundings_k = 293.15


def radiance(temperature_k):
    """Photon radiance and its derivative by temperature."""
    x = SECOND_RADIATION_CM_K * nu / temperature_k
    value = PREFACTOR * nu**2 / np.expm1(x)
    return value, value * x / (temperature_k * -np.expm1(-x))


def local(temperature_k, lighting):
    """d0 with temperature and lighting unknown: what least squares leaves of the material's score."""
    body, slope = radiance(temperature_k)
    around, _ = radiance(surroundings_k)
    signal = skin * body + (1.0 - skin) * lighting * around
    root = np.sqrt(signal * signal.sum())
    nuisances = np.column_stack([skin * slope, (1.0 - skin) * around]) / root[:, None]
    score = (robot - skin) * (body - lighting * around) / root
    basis, _ = np.linalg.qr(nuisances)
    return 0.5 * np.linalg.norm(score - basis @ (basis.T @ score))


def local_map(temperatures_k, lightings):
    """Sum of d0 over a grid; a row of the grid at a time, Gram-Schmidt along the bands."""
    around, _ = radiance(surroundings_k)
    lit = lightings[:, None] * around
    total = 0.0
    for temperature_k in temperatures_k:
        body, slope = radiance(temperature_k)
        signal = skin * body + (1.0 - skin) * lit
        weight = 1.0 / np.sqrt(signal * signal.sum(axis=1, keepdims=True))
        columns = [skin * slope * weight, (1.0 - skin) * around * weight, (robot - skin) * (body - lit) * weight]
        for i, column in enumerate(columns):
            for earlier in columns[:i]:
                column -= np.einsum("ij,ij->i", column, earlier)[:, None] * earlier
            if i < 2:
                column /= np.linalg.norm(column, axis=1)[:, None]
        total += 0.5 * np.linalg.norm(columns[2], axis=1).sum()
    return total


def nearest(temperature_k, lighting):
    """Half the distance to the robot's nearest state: a grid of temperatures, then Gauss-Newton."""
    around, _ = radiance(surroundings_k)
    signal = skin * radiance(temperature_k)[0] + (1.0 - skin) * lighting * around
    photons = signal.sum()
    root = np.sqrt(signal / photons)
    column = (1.0 - robot) * around

    def fitted(t):
        rest = (signal - robot * radiance(t)[0]) / np.sqrt(signal)
        weighted = column / np.sqrt(signal)
        v = np.clip(rest @ weighted / (weighted @ weighted), 0.0, 1.0)
        return np.linalg.norm(rest - v * weighted), t, v

    _, t, v = min(fitted(t) for t in np.geomspace(130.0, 500.0, 32))
    for _ in range(5):
        body, slope = radiance(t)
        other = np.sqrt((robot * body + v * column) / photons)
        jacobian = np.column_stack([robot * slope, column]) / (2.0 * photons * other[:, None])
        step, *_ = np.linalg.lstsq(jacobian, root - other, rcond=None)
        t, v = t + step[0], np.clip(v + step[1], 0.0, 1.0)
    other = np.sqrt((robot * radiance(t)[0] + v * column) / photons)
    return np.linalg.norm(root - other)


def best(function, runs):
    """Shortest of several runs, in microseconds, and the last result."""
    shortest = np.inf
    for _ in range(runs):
        start = time.perf_counter()
        result = function()
        shortest = min(shortest, time.perf_counter() - start)
    return shortest * 1e6, result


if __name__ == "__main__":
    grid = np.linspace(280.0, 340.0, 300), np.linspace(0.01, 0.99, 300)
    for name, function, runs in [
        ("local, one pair", lambda: local(310.15, 0.5), 2000),
        ("nearest, one pair", lambda: nearest(310.15, 0.5), 200),
        ("local, 300 x 300 map", lambda: local_map(*grid), 5),
    ]:
        microseconds, result = best(function, runs)
        print(f"{name:24} {microseconds:12.1f} us   {result:.12g}")
