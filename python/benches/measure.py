"""What calls cost, against NumPy and over Dask; the figures of README.md.

    python measure.py calls
    python measure.py peer PATH/numpy_peer.py
    python measure.py dask
"""

import importlib.util
import os
import sys
import time

import numpy as np

import hadar_limits as hadar


def best(work, repeat=5, calls=1):
    """Seconds of a call, the best of some."""
    found = []
    for _ in range(repeat):
        start = time.perf_counter()
        for _ in range(calls):
            value = work()
        found.append((time.perf_counter() - start) / calls)
    return min(found), value


def calls():
    for bands in (4, 536):
        nu = np.linspace(715.0, 1250.0, bands)
        skin, metal = np.full(bands, 0.95), 0.5 + 1e-4 * (nu - 715) - 3e-7 * (nu - 900) ** 2
        scene = hadar.Scene(nu, 310.15, [0.5], [293.15])
        for name, work in [
            ("planck", lambda: hadar.planck(nu, 310.15)),
            ("Scene", lambda: hadar.Scene(nu, 310.15, [0.5], [293.15])),
            ("local", lambda: hadar.local(skin, metal, scene)),
            ("nearest", lambda: hadar.nearest(skin, metal, scene)),
        ]:
            print(f"{name} of {bands} bands: {1e6 * best(work, 400, 10)[0]:.2f} us")
        # The same without the call: a thousand in one.
        states = np.full(1000, 310.15), np.full(1000, 0.5)
        for by, prove in (("local", None), ("nearest", 1e-6)):
            many = lambda: hadar.over_states(skin, metal, scene, *states, by=by, prove=prove, threads=1)
            print(f"{by} of {bands} bands, of a thousand: {1e3 * best(many, 20)[0]:.2f} us")


def peer(path):
    spec = importlib.util.spec_from_file_location("numpy_peer", path)
    numpy_peer = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(numpy_peer)
    nu, skin, metal = numpy_peer.NU, numpy_peer.SKIN, numpy_peer.ALU
    pair = hadar.Scene(nu, 310.15, [0.5], [293.15])
    library, warm = numpy_peer.library(), hadar.Scene(nu, 333.15, [0.5], [293.15])

    def map_of_states():
        t, v = np.meshgrid(np.linspace(280, 340, 300), np.linspace(0.01, 0.99, 300), indexing="ij")
        return hadar.over_states(skin, metal, pair, t, v, threads=1).sum()

    cube = numpy_peer.cube(540, 960, 54)

    def windows(threads=1):
        # Without those whose derivative is none, which the peer counts as 0.
        return np.nansum(hadar.window_information(cube, threads=threads).full)

    def windows_of_peer():
        d = np.zeros_like(cube)
        d[:, 1:-1] = (cube[:, 2:] - cube[:, :-2]) / 2
        f = (d * d / cube).sum(2, dtype=np.float64)
        s = np.pad(f, ((1, 0), (1, 0))).cumsum(0).cumsum(1)
        return (s[5:, 5:] - s[:-5, 5:] - s[5:, :-5] + s[:-5, :-5])[:, 1:-1].sum()

    numpy_peer.CUBE["a"] = cube
    for name, own, other, repeat, number in [
        ("pair", lambda: hadar.local(skin, metal, pair).distance, numpy_peer.case_pair, 300, 10),
        ("library", lambda: hadar.matrix(library, warm, threads=1).sum(), numpy_peer.case_library, 50, 1),
        ("map", map_of_states, numpy_peer.case_map, 2, 1),
        ("ranging", windows, windows_of_peer, 3, 1),
    ]:
        (mine, value), (theirs, expected) = best(own, repeat, number), best(other, repeat, number)
        print(f"{name}: hadar {1e3 * mine:.4g} ms, NumPy {1e3 * theirs:.4g} ms, values differ by {value / expected - 1:.1e}")


def over_dask():
    import dask
    import dask.array
    from distributed import Client, LocalCluster

    import hadar_limits.dask

    nu = np.arange(800.0, 1201.0, 8.0)
    t = (nu - 1000) / 200
    random = np.random.default_rng(1)
    library = np.clip(0.85 + sum(random.uniform(-0.05, 0.05, (12, 1)) * np.cos(k * np.pi * t) for k in range(1, 6)), 0.05, 0.99)
    light = hadar.planck(nu, [[290.0], [250.0]])
    rows, columns = 512, 640
    e = library[random.integers(0, 12, (rows // 8, columns // 8)).repeat(8, 0).repeat(8, 1)]
    s = e * hadar.planck(nu, random.uniform(285, 320, (rows, columns, 1))) + (1 - e) * (0.5 * light[0] + 0.3 * light[1])
    counts = random.poisson(3e-16 * 8 * s).astype("f4")
    options = dict(counts_per_radiance=3e-16)
    print(f"cube {counts.shape}, {counts.nbytes / 1e6:.0f} MB; {os.cpu_count()} cores")
    for threads in (1, 2):
        seconds, maps = best(lambda: hadar.decompose(counts, library, light, nu, threads=threads, **options), 2)
        print(f"one process, {threads} threads: {seconds:.2f} s, {1e6 * seconds / counts[..., 0].size:.1f} us a pixel")
    back = sum(values.nbytes for values in maps.to_dict().values())
    print(f"maps {back / 1e6:.1f} MB, {back / counts[..., 0].size:.0f} bytes a pixel against {counts.shape[2] * 4} of the cube")
    folder = os.environ.get("TMPDIR", "/tmp")
    file = os.path.join(folder, f"cube-{os.getpid()}.npy")
    np.save(file, counts)
    for workers in (1, 2):
        with LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
            with Client(cluster) as client:
                client.run(lambda: __import__("hadar_limits"))
                empty = [dask.delayed(abs)(-i) for i in range(2000)]
                seconds, _ = best(lambda: dask.compute(*empty), 3)
                print(f"{workers} workers, tasks that do nothing: {1e3 * seconds / len(empty):.2f} ms each")
                for chunk in (32, 64, 128):
                    mapped = np.load(file, mmap_mode="r")
                    lazy = dask.array.map_blocks(
                        _rows_of, file, chunk, chunks=((chunk,) * (rows // chunk), (columns,), (len(nu),)), dtype="f4", meta=mapped[:0, :0]
                    )
                    maps = hadar.dask.decompose(lazy, library, light, nu, **options)
                    seconds, _ = best(lambda: maps.compute(), 2)
                    print(f"{workers} workers, chunks of {chunk} rows ({chunk * columns * len(nu) * 4 / 1e6:.1f} MB): {seconds:.2f} s")
                scenario = {
                    "target": {"material": "skin", "temperature": "37 degC"},
                    "environment": [{"temperature": "20 degC", "lighting": 0.5}],
                    "alternatives": {"materials": ["aluminium"]},
                }
                axes = {"t": hadar.dask.Axis("target.temperature", np.linspace(290, 330, 200), "K")}
                for batch in (1, 10):
                    sweep = hadar.dask.sweep(hadar.identify, scenario, axes, {"d": ("pairs.0.distance_nearest", "")}, batch=batch)
                    seconds, _ = best(lambda: sweep.compute(), 2)
                    print(f"{workers} workers, 200 questions in tasks of {batch}: {1e3 * seconds / 200:.2f} ms a question")
    seconds, _ = best(lambda: hadar.identify(scenario, threads=1), 3, 10)
    print(f"one process: {1e3 * seconds:.2f} ms a question")
    os.remove(file)


def _rows_of(file, chunk, block_info=None):
    first = block_info[None]["array-location"][0][0]
    return np.array(np.load(file, mmap_mode="r")[first : first + chunk])


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["calls"]:
            calls()
        case ["peer", path]:
            peer(path)
        case ["dask"]:
            over_dask()
        case _:
            print(__doc__)
