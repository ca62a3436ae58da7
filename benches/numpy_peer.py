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


# The cases with a library: 30 made-up materials, the target at 60 °C.
LIBRARY_K, LIBRARY_LIGHTING = 333.15, 0.5
places = (nu - 985.0) / 265.0
library = np.clip(
    0.8
    + sum(
        0.1 * np.sin(1.7 * (np.arange(30) * 5 + j + 1))[:, None] * np.cos((j + 1) * np.pi * (places + 1.0))
        for j in range(5)
    ),
    0.05,
    0.99,
)
CAMERA_PHOTONS, CAMERA_NOISE = 1e6, 100.0


def local_matrix():
    """d0 of every target against all others: one QR per target."""
    body, slope = radiance(LIBRARY_K)
    around, _ = radiance(surroundings_k)
    distances = np.empty((len(library), len(library)))
    for row, own in zip(distances, library):
        signal = own * body + (1.0 - own) * LIBRARY_LIGHTING * around
        root = np.sqrt(signal * signal.sum())
        basis, _ = np.linalg.qr(np.column_stack([own * slope, (1.0 - own) * around]) / root[:, None])
        scores = (library - own) * ((body - LIBRARY_LIGHTING * around) / root)
        left = scores - (scores @ basis) @ basis.T
        row[:] = 0.5 * np.linalg.norm(left, axis=1)
    return distances


def nearest_row(own, counts, noise):
    """Half the distances of one target to the nearest states of all materials, with counts and noise given.

    All materials at once: a grid of temperatures, then Gauss-Newton steps with the lighting kept within 0 and 1.
    """
    around, _ = radiance(surroundings_k)
    signal = own * radiance(LIBRARY_K)[0] + (1.0 - own) * LIBRARY_LIGHTING * around
    if counts is None:
        counts = 1.0 / signal.sum()
    root = np.sqrt(counts * signal + noise)
    scattered = (1.0 - library) * around
    weight = 0.5 * counts / root
    weighted = scattered * weight
    square = np.einsum("ij,ij->i", weighted, weighted)
    cost, t, v = np.full(len(library), np.inf), np.empty(len(library)), np.empty(len(library))
    for temperature_k in np.geomspace(130.0, 500.0, 32):
        rest = (signal - library * radiance(temperature_k)[0]) * weight
        fitted = np.clip(np.einsum("ij,ij->i", rest, weighted) / square, 0.0, 1.0)
        left = rest - fitted[:, None] * weighted
        now = np.einsum("ij,ij->i", left, left)
        better = now < cost
        cost[better], t[better], v[better] = now[better], temperature_k, fitted[better]
    for _ in range(5):
        x = SECOND_RADIATION_CM_K * nu / t[:, None]
        body = PREFACTOR * nu**2 / np.expm1(x)
        slope = body * x / (t[:, None] * -np.expm1(-x))
        other = np.sqrt(counts * (library * body + v[:, None] * scattered) + noise)
        along_t, along_v = library * slope * (0.5 * counts / other), scattered * (0.5 * counts / other)
        rest = root - other
        tt, tv, vv = (np.einsum("ij,ij->i", a, b) for a, b in [(along_t,) * 2, (along_t, along_v), (along_v,) * 2])
        rt, rv = np.einsum("ij,ij->i", along_t, rest), np.einsum("ij,ij->i", along_v, rest)
        step_v = np.clip((rv * tt - rt * tv) / (tt * vv - tv * tv), -v, 1.0 - v)
        t, v = t + (rt - tv * step_v) / tt, v + step_v
    body = PREFACTOR * nu**2 / np.expm1(SECOND_RADIATION_CM_K * nu / t[:, None])
    return np.linalg.norm(root - np.sqrt(counts * (library * body + v[:, None] * scattered) + noise), axis=1)


def nearest_matrix():
    """Nearest distances per root photon of every target against all others."""
    distances = np.array([nearest_row(own, None, 0.0) for own in library])
    np.fill_diagonal(distances, 0.0)
    return distances


def told_apart(required):
    """How many pairs a camera tells apart: the nearest distance reaches what is required both ways."""
    counts = CAMERA_PHOTONS / radiance(LIBRARY_K)[0].sum()
    distances = np.array([nearest_row(own, counts, CAMERA_NOISE) for own in library])
    apart = np.minimum(distances, distances.T) >= required
    return np.triu(apart, 1).sum()


def drawn_and_judged(spectra=5000):
    """Share of right decisions of the likelihood ratio on Poisson spectra of the person and the nearest robot, d = 1."""
    rng = np.random.default_rng(1)
    around, _ = radiance(surroundings_k)
    person = skin * radiance(310.15)[0] + (1.0 - skin) * 0.5 * around
    other = robot * radiance(355.951)[0] + (1.0 - robot) * 0.1867 * around
    means = [signal * 1.2763e6 / person.sum() for signal in (person, other)]
    weights, offset = np.log(means[1] / means[0]), means[1].sum() - means[0].sum()
    ratios = [rng.poisson(mean, (spectra, nu.size)) @ weights - offset for mean in means]
    return 0.5 * ((ratios[0] < 0).mean() + (ratios[1] > 0).mean())


def best(function, runs):
    """Shortest of several runs, in microseconds, and the last result."""
    shortest = np.inf
    for _ in range(runs):
        start = time.perf_counter()
        result = function()
        shortest = min(shortest, time.perf_counter() - start)
    return shortest * 1e6, result


if __name__ == "__main__":
    for name, function, runs in [
        ("local, one pair", lambda: local(310.15, 0.5), 2000),
        ("nearest, one pair", lambda: nearest(310.15, 0.5), 200),
        ("local, 30 x 30", lambda: local_matrix().sum(), 100),
        ("nearest, 30 x 30", lambda: nearest_matrix().sum(), 5),
        ("told apart at d = 1", lambda: told_apart(1.0), 5),
        ("told apart at d = 40", lambda: told_apart(40.0), 5),
        ("10 000 spectra judged", drawn_and_judged, 5),
    ]:
        microseconds, result = best(function, runs)
        print(f"{name:24} {microseconds:12.1f} us   {result:.12g}")
