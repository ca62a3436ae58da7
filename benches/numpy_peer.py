"""The cases of the benches as a good user of NumPy writes them: products of matrices, Newton's steps of many pairs at once.

    python3 benches/numpy_peer.py [CASE [NUMBER]]

prints of every case CPU milliseconds of one thread, the least of several runs, and the result that the bench prints too. Scene and
materials are those of `matrices.rs`. There is no estimate of rounding: products lose digits where materials are nearly equal.
Nothing is proved: a nearest state is the one that Newton's method finds from the best of a grid of temperatures.
"""

import os
import sys
import time

for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ[f"{library}_NUM_THREADS"] = "1"
import numpy as np

NU = 715.0 + np.arange(536)  # cm^-1
C2_NU = 1.438776877503934 * NU  # hc nu/k in K
MODES = 2.0 * 2.99792458e8 * 1e6 * NU**2  # photons s^-1 m^-2 sr^-1 per cm^-1
TARGET_K, LIGHTING = 333.15, 0.5


def planck(temperature_k):
    return MODES / np.expm1(C2_NU / temperature_k)


AROUND = planck(293.15)
GRID_K = np.geomspace(130.0, 500.0, 40)
GRID = planck(GRID_K[:, None])
GRID_SQUARES = GRID * GRID
BLOCK = 32  # Alternatives at a time: their spectra stay in the cache.


def spread(places, irrational):
    return (places + 1) * irrational % 1.0


def made_up(count):
    """The emissivities of `made_up.rs`, [material][band]."""
    place = np.arange(count)[:, None]
    wave = np.sin(NU / (20.0 + 100.0 * spread(place, 3**0.5)) + 6.0 * spread(place, 5**0.5))
    return np.clip(0.3 + 0.68 * spread(place, 2**0.5) + 0.1 * wave, 0.02, 0.99)


SKIN = np.full((1, NU.size), 0.95)
ROBOT = np.polynomial.Polynomial([0.49287, -0.0782, 0.00892])((NU - 985.0) / 265.0)[None]


def local(targets, others, temperature_k=TARGET_K):
    """Local distances of every target to all others: the score of the material, less its part in temperature and lighting.

    (e' - e)^2 and (e' - e) are multiplied out, so that sums over bands are products of matrices.
    """
    x, body = C2_NU / temperature_k, planck(temperature_k)
    contrast = body - LIGHTING * AROUND
    signal = targets * contrast + LIGHTING * AROUND
    weight = contrast / signal
    by_t = targets * (body * x / -np.expm1(-x))
    by_v = (1.0 - targets) * AROUND
    dot = lambda a, b: np.vecdot(a, b)[:, None]
    w, wt, wv = weight * contrast, weight * by_t, weight * by_v
    gg = w @ (others * others).T - 2.0 * (w * targets) @ others.T + dot(w * targets, targets)
    gt, gv = wt @ others.T - dot(wt, targets), wv @ others.T - dot(wv, targets)
    tt, tv, vv = dot(by_t / signal, by_t), dot(by_t / signal, by_v), dot(by_v / signal, by_v)
    part = (vv * gt**2 - 2.0 * tv * gt * gv + tt * gv**2) / (tt * vv - tv**2)
    return 0.5 * np.sqrt(np.maximum(gg - part, 0.0) / signal.sum(1)[:, None])


def local_pair(target, other, temperature_k):
    """The same of one pair: what is left of the score's square in the Gram matrix of the score and both unknowns."""
    x, body = C2_NU / temperature_k, planck(temperature_k)
    contrast = body - LIGHTING * AROUND
    signal = target * contrast + LIGHTING * AROUND
    columns = np.array(((other - target) * contrast, target * (body * x / -np.expm1(-x)), (1.0 - target) * AROUND))
    (gg, gt, gv), (_, tt, tv), (_, _, vv) = ((columns / signal) @ columns.T).tolist()
    part = (vv * gt**2 - 2.0 * tv * gt * gv + tt * gv**2) / (tt * vv - tv**2)
    return 0.5 * ((gg - part) / signal.sum()) ** 0.5


def nearest(targets, others, temperature_k=TARGET_K, counts=None, noise=0.0, bands=slice(None), enough=1e-9):
    """Nearest distances of every target to all others: a grid, a parabola about its best place, steps of Gauss and Newton."""
    around, grid, grid_squares, c2_nu, modes = AROUND[bands], GRID[:, bands], GRID_SQUARES[:, bands], C2_NU[bands], MODES[bands]
    targets, others = np.ascontiguousarray(targets[:, bands]), np.ascontiguousarray(others[:, bands])
    signals = targets * planck(temperature_k)[bands] + (1.0 - targets) * LIGHTING * around
    squares, scattered = others * others, (1.0 - others) * around
    mixed, scattered_squares = others * scattered, scattered * scattered
    found = np.empty((len(targets), len(others)))
    for row, signal in zip(found, signals):
        each = 1.0 / signal.sum() if counts is None else counts
        root = np.sqrt(each * signal + noise)
        u = (0.5 * each / root) ** 2
        # Squared misses at the temperatures of the grid with the best lighting: quadratic in both.
        sb = signal * u
        rr = sb @ signal - 2.0 * (others * sb) @ grid.T + (squares * u) @ grid_squares.T
        rq = (scattered @ sb)[:, None] - (mixed * u) @ grid.T
        qq = (scattered_squares @ u)[:, None]
        lighting = np.clip(rq / qq, 0.0, 1.0)
        cost = rr + lighting * (lighting * qq - 2.0 * rq)
        best, all_rows = cost.argmin(1), np.arange(len(others))
        middle = np.clip(best, 1, len(GRID_K) - 2)
        low, mid, high = (cost[all_rows, middle + step] for step in (-1, 0, 1))
        shift = np.where(best == middle, 0.5 * (low - high) / np.maximum(low - 2.0 * mid + high, 1e-300), 0.0)
        t = GRID_K[best] * (GRID_K[1] / GRID_K[0]) ** shift
        v = lighting[all_rows, best]
        for start in range(0, len(others), BLOCK):
            left = np.arange(start, min(start + BLOCK, len(others)))
            e, q, t_, v_ = others[left], scattered[left], t[left, None], v[left, None]
            for _ in range(50):
                x = c2_nu / t_
                p = np.expm1(x)
                body = e * (modes / p)
                other = np.sqrt(each * (body + v_ * q) + noise)
                half, miss = 0.5 * each / other, root - other
                by_t, by_v = body * (x + x / p) * half, q * half
                pairs = ((by_t, by_t), (by_t, by_v), (by_v, by_v), (by_t, miss), (by_v, miss), (miss, miss))
                tt, tv, vv, rt, rv, rr = (np.vecdot(a, b)[:, None] for a, b in pairs)
                dv = np.clip((rv * tt - rt * tv) / np.maximum(tt * vv - tv * tv, 1e-300), -v_, 1.0 - v_)
                dt = (rt - tv * dv) / tt
                gain = dt * (2.0 * rt - tt * dt - 2.0 * tv * dv) + dv * (2.0 * rv - vv * dv)
                row[left] = np.sqrt(np.maximum(rr - gain, 0.0))[:, 0]
                more = (gain > enough * rr + 1e-20)[:, 0]
                if not more.any():
                    break
                left, e, q = left[more], e[more], q[more]
                t_, v_ = (t_ * (1.0 + dt))[more], (v_ + dv)[more]
    return found


def nearest_pair(target, other, temperature_k):
    """The same of one pair, in plain vectors and numbers."""
    signal = target * planck(temperature_k) + (1.0 - target) * LIGHTING * AROUND
    each = 1.0 / signal.sum()
    root, scattered = np.sqrt(each * signal), (1.0 - other) * AROUND
    weighted = 0.25 * each / signal * np.array((signal, other, scattered))
    rq, qq = weighted[2] @ signal - GRID @ (weighted[2] * other), weighted[2] @ scattered
    lighting = np.clip(rq / qq, 0.0, 1.0)
    cost = GRID_SQUARES @ (weighted[1] * other) - 2.0 * GRID @ (weighted[1] * signal) + lighting * (lighting * qq - 2.0 * rq)
    best = int(cost.argmin())
    t, v = GRID_K[best].item(), lighting[best].item()
    if 0 < best < len(GRID_K) - 1:
        low, mid, high = cost[best - 1 : best + 2].tolist()
        t *= (GRID_K[1] / GRID_K[0]).item() ** (0.5 * (low - high) / (low - 2.0 * mid + high))
    for _ in range(50):
        x = C2_NU / t
        p = np.expm1(x)
        body = other * (MODES / p)
        now = np.sqrt(each * (body + v * scattered))
        half = 0.5 * each / now
        columns = np.array((body * (x + x / p) * half, scattered * half, root - now))
        (tt, tv, rt), (_, vv, rv), (_, _, rr) = (columns @ columns.T).tolist()
        dv = min(max((rv * tt - rt * tv) / (tt * vv - tv * tv), -v), 1.0 - v)
        dt = (rt - tv * dv) / tt
        gain = dt * (2.0 * rt - tt * dt - 2.0 * tv * dv) + dv * (2.0 * rv - vv * dv)
        if gain <= 1e-9 * rr:
            break
        t, v = t * (1.0 + dt), v + dv
    return (rr - gain) ** 0.5


def told_apart(materials, required):
    """Pairs whose nearest distance reaches what is required both ways, of a camera with 10^6 photons and 10 electrons of noise in a band.

    A distance of a part of the bands is no greater than that of all: every eighth band first, then all where these do not suffice.
    """
    camera = {"counts": 1e6 / planck(TARGET_K).sum(), "noise": 100.0, "enough": 1e-4}
    apart = nearest(materials, materials, bands=slice(None, None, 8), **camera) >= required
    for i, row in enumerate(apart):
        rest = np.flatnonzero(~row & (np.arange(len(row)) != i))
        if rest.size:
            row[rest] = nearest(materials[i : i + 1], materials[rest], **camera)[0] >= required
    return np.triu(apart & apart.T, 1).sum()


def judged(spectra=5000, at_once=100):
    """Share of correct decisions of the likelihood ratio on Poisson spectra of the person and the nearest robot, d = 1."""
    draws = np.random.Generator(np.random.SFC64(1))
    person = (SKIN * planck(310.15) + (1.0 - SKIN) * 0.5 * AROUND)[0]
    robot = (ROBOT * planck(355.951) + (1.0 - ROBOT) * 0.1867 * AROUND)[0]
    means = [signal * 1.2763e6 / person.sum() for signal in (person, robot)]
    weights, offset = np.log(means[1] / means[0]), means[1].sum() - means[0].sum()
    right = 0
    for mean, sign in zip(means, (-1.0, 1.0)):
        for _ in range(spectra // at_once):
            right += (sign * (draws.poisson(mean, (at_once, NU.size)) @ weights - offset) > 0.0).sum()
    return right / (2 * spectra)


def counts(shape=(540, 960, 54)):
    """The cube of `made_up.rs`."""
    place = np.arange(np.prod(shape))
    return (1e4 + 4096.0 * spread(place, 2**0.5) + place % shape[2]).astype(np.float32).reshape(shape)


def windows(cube, side=5, rows=2):
    """Information about x of all windows with both resolutions: sums of (dN/dx)^2/N."""
    pixels = np.zeros((cube.shape[0] + 1, cube.shape[1] - 1))
    for start in range(0, len(cube), rows):
        n = cube[start : start + rows].astype(float)
        slope = n[:, 2:] - n[:, :-2]
        pixels[start + 1 : start + 1 + len(n), 1:] = 0.25 * np.vecdot(slope / n[:, 1:-1], slope)
    total = pixels.cumsum(0).cumsum(1)
    down = total[side:] - total[:-side]
    return down[:, side:] - down[:, :-side]


def least(call, seconds=0.5):
    """CPU milliseconds of the fastest of the runs of half a second, and the result."""
    shortest, spent = np.inf, 0.0
    while spent < seconds:
        start = time.process_time()
        result = call()
        now = time.process_time() - start
        shortest, spent = min(shortest, now), spent + now
    return 1e3 * shortest, result


def off_diagonal(distances):
    return distances.sum() - np.trace(distances)


def cases():
    """Name, number of materials or distance, what is made ready, what is timed and gives the result."""
    yield "local", "pair", lambda: None, lambda _: local_pair(SKIN[0], ROBOT[0], 310.15)
    yield "nearest", "pair", lambda: None, lambda _: nearest_pair(SKIN[0], ROBOT[0], 310.15)
    for count in (30, 300, 1000):
        yield "local", count, lambda: made_up(count), lambda one: off_diagonal(local(one, one))
    for count in (30, 300):
        yield "nearest", count, lambda: made_up(count), lambda one: off_diagonal(nearest(one, one))
    for count in (30, 300, 1000):
        yield "apart", count, lambda: made_up(count), lambda one: told_apart(one, 1.0)
    for count in (30, 300):
        yield "close", count, lambda: made_up(count), lambda one: told_apart(one, 20.0)
    yield "judged", "spectra", lambda: None, lambda _: judged()
    yield "windows", "5 x 5", counts, lambda cube: windows(cube).sum()


if __name__ == "__main__":
    for name, number, ready, run in cases():
        if all(asked in (name, str(number)) for asked in sys.argv[1:]):
            made = ready()
            milliseconds, result = least(lambda: run(made))
            print(f"{name} {number}: {milliseconds:.4g} ms, {result:.12g}", flush=True)
