"""What the program is given before anything is changed: small files of every kind, and the commands that read them.

A line of COMMANDS is a command and the files that it reads; the first of them is the one that it is named, which is changed most often.
Every file is small, so that a run takes some hundredths of a second.
"""

import math
import shutil
import struct
import subprocess
import zipfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]

SIZE = """title = "Skin or aluminium"
[target]
material = "skin"
temperature = "37 degC"
distance = "30 m"
size = "0.5 m"
[background]
temperature = "15 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "pmma"]
temperature = ["0 degC", "120 degC"]
[bands]
start = "750 cm^-1"
stop = "1250 cm^-1"
step = "50 cm^-1"
[camera]
preset = "flir-a325sc"
exposure = "10 ms"
frames = 4
[requirement]
detection_probability = 0.99
speed = "30 mph"
"""

FILES = """[target]
material = "my.csv"
temperature = "37 degC"
distance = "30 m"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "two.csv"]
[atmosphere]
table = "air.csv"
temperature = "15 degC"
[bands]
filters = "filters.csv"
[camera]
exposure = "12 ms"
pixel = "12 um"
f_number = 1.3
focal_length = "18 mm"
noise_electrons = 1e5
quantum_efficiency = "efficiency.csv"
"""

PRIORS = """[target]
material = "skin"
temperature = "37 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium"]
[bands]
rows = "bands.csv"
[unknown]
nuisances = ["temperature", "lighting"]
priors = { temperature = "2 K" }
[camera]
preset = "flir-a325sc"
exposure = "10 ms"
full_well = 1e9
[sensitivity]
emissivity_error = 0.005
"""

AVERAGE = """[target]
material = "skin"
temperature = "37 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium"]
[bands]
start = "800 cm^-1"
stop = "1200 cm^-1"
step = "200 cm^-1"
[unknown]
nuisances = ["temperature"]
priors = { temperature = "2 K" }
"""

OWN_CAMERA = """[target]
material = "skin"
temperature = "37 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "sum", "soot"]
[bands]
step = "100 cm^-1"
[camera]
preset = "my-core"
"""

CAMERAS = """[[camera]]
name = "my-core"
exposure = "12 ms"
pixel = "12 um"
f_number = 1.3
focal_length = "18 mm"
netd = "50 mK"
readout = "simultaneous"
"""

MANIFEST = """version = 1
[[material]]
name = "sum"
model = { table = "my.csv" }
[[material]]
name = "soot"
model = { constant = 0.5 }
"""

RULE = """cameras = ["flir-a325sc", "ideal-pnrd"]
[rule]
name = "People and robots"
[target]
material = "skin"
temperature = "33 degC"
[[environment]]
temperature = "10 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium", "two.csv"]
[bands]
start = "750 cm^-1"
stop = "1250 cm^-1"
step = "100 cm^-1"
[envelope]
temperature = ["25 degC", "37 degC"]
lighting = [0.2, 0.8]
distance = ["5 m", "15 m"]
"""

STREET = """[scene]
size = [24, 32]
ground_temperature = "12 degC"
sky_temperature = "-15 degC"
ground_emissivity = [0.9, 0.98]
person = "my.csv"
person_distance = "8 m"
[bands]
start = "720 cm^-1"
stop = "1240 cm^-1"
step = "130 cm^-1"
[camera]
exposure = "12 ms"
pixel = "240 um"
f_number = 1.4
focal_length = "14 mm"
noise_electrons = 3000
[stereo]
baseline = "0.2 m"
window = [3, 3]
lines = [15]
[requirement]
relative_depth_error = 0.01
"""

STEREO = """[cube]
left = "left.npy"
right = "right.npy"
photons_per_unit = 2.5
noise_variance = "noise.csv"
depth = "depth.npy"
[stereo]
baseline = "0.02 m"
focal_length = "14 mm"
pixel = "12 um"
window = [3, 5]
lines = [4]
diffraction = "gaussian"
psf_sigma = "5 um"
[requirement]
depth_error = "10 cm"
"""

STEREO_MATLAB = """[cube]
left = "left.mat"
variable = "S"
noise_variance = 5
depth = "12 m"
[stereo]
baseline = "0.2 m"
focal_length = "14 mm"
pixel = "12 um"
window = [1, 1]
"""

# Radiances without noise, and a library with errors: chi-squared is exactly 0 in a pixel that fits.
EXACT = """[cube]
data = "exact.npy"
counts_per_photon_radiance = 1e-13
noise = 300
[bands]
start = "800 cm^-1"
stop = "1080 cm^-1"
step = "20 cm^-1"
[[environment]]
temperature = "10 degC"
[library]
path = "library15.csv"
emissivity_error = 0.01
emissivity_correlation = "50 cm^-1"
[unknown]
temperature = ["250 K", "340 K"]
lighting_total = 1.0
[spatial]
prior = "potts"
weight = 1.0
[vision]
sky = 0
[[category]]
name = "w"
materials = ["wall"]
[[category]]
name = "p"
materials = ["panel"]
"""

BLACKBODY = """[bands]
start = "800 cm^-1"
stop = "1200 cm^-1"
step = "200 cm^-1"
[[blackbody]]
temperature = "10 degC"
uncertainty = "30 mK"
data = "cold.npy"
[[blackbody]]
temperature = "60 degC"
uncertainty = "30 mK"
data = "warm.npy"
[noise]
sample = 2.0
[scene]
data = "left.npy"
"""

NOISE = """[cube]
data = "left.npy"
frames = ["right.npy"]
"""

SPECTRA = {
    "my.csv": "wavenumber_cm1,emissivity\n600,0.9\n900,0.95\n1400,0.8\n",
    "two.csv": "wavelength_um,reflectance\n6,0.5\n10,0.25\n20,0.1\n",
    "air.csv": "wavenumber_cm1,tau_10m,tau_100m\n600,0.9,0.5\n1400,0.99,0.9\n",
    "filters.csv": "wavelength_um,a,b,c,d\n8,0,0,0,0\n9,1,0,0,0\n10,0,1,0,0\n11,0,0,1,0\n12,0,0,0,1\n13,0,0,0,0\n",
    "bands.csv": "wavenumber_cm1,width_cm1\n760,10\n800,20\n900,20\n1000,20\n1100,20\n1200,10\n",
    "efficiency.csv": "wavenumber_cm1,efficiency\n600,0.5\n1400,0.8\n",
    "noise.csv": "band,variance_counts2\n1,50\n2,60\n3,70\n",
    "cases.csv": "target.temperature,camera.exposure,target.material\n20 degC,10 ms,skin\n30 degC,,my.csv\n40 degC,1 ms,pmma\n",
    "library15.csv": "wavenumber_cm1,wall,panel,=cmd\n"
    + "".join(f"{nu},{0.9 + 0.05 * math.sin(nu / 40):.6f},{0.3 + nu / 4000:.6f},0.6\n" for nu in range(800, 1081, 20)),
}


def npy(shape, value):
    """A cube of 32-bit numbers as NumPy writes it; `value` of row, column and band."""
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': {tuple(shape)}, }}"
    header += " " * (-(len(header) + 11) % 64) + "\n"
    rows, columns, bands = shape
    samples = [value(i, j, k) for i in range(rows) for j in range(columns) for k in range(bands)]
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + struct.pack(f"<{len(samples)}f", *samples)


def textured(level):
    return lambda i, j, k: level * (1 + 0.1 * math.sin(0.7 * (i * 72 + j * 3 + k)))


def planck(wavenumber_cm1, temperature_k):
    """Photon radiance of a blackbody, photons s^-1 m^-2 sr^-1 per cm^-1."""
    return 2 * 299792458.0 * (100 * wavenumber_cm1) ** 2 * 100 / math.expm1(1.438776877 * wavenumber_cm1 / temperature_k)


def exact(i, j, k):
    """A wall of 300 K and a panel of 290 K in surroundings of 283.15 K."""
    nu = 800 + 20 * k
    emissivity, temperature = (0.9 + 0.05 * math.sin(nu / 40), 300) if j < 4 else (0.3 + nu / 4000, 290)
    return 1e-13 * (emissivity * planck(nu, temperature) + (1 - emissivity) * planck(nu, 283.15))


def coarse(text):
    """An example that takes some hundredths of a second."""
    for large, small in [
        ('step = "0.48 cm^-1"', 'step = "40 cm^-1"'),
        ('step = "1 cm^-1"', 'step = "40 cm^-1"'),
        ('step = "10 cm^-1"', 'step = "130 cm^-1"'),
        ("# size = [480, 640]", "size = [24, 32]"),
        ("size = [480, 640]", "size = [24, 32]"),
        ("size = [240, 320]", "size = [24, 32]"),
        ("size = [60, 80]", "size = [10, 16]"),
        ("lines = [300]", "lines = [15]"),
        ("lines = [330]", "lines = [15]"),
        ('pixel = "24 um"', 'pixel = "240 um"'),
        ('pixel = "96 um"', 'pixel = "300 um"'),
        ('pixel = "12 um"\nf_number = 1.4', 'pixel = "240 um"\nf_number = 1.4'),
        ("../street/", ""),
    ]:
        text = text.replace(large, small)
    return text


def make(hadar, pool):
    """Fills the folder `pool` with every file of COMMANDS."""
    texts = {
        "size.toml": SIZE, "files.toml": FILES, "priors.toml": PRIORS, "average.toml": AVERAGE, "own.toml": OWN_CAMERA, "cameras.toml": CAMERAS,
        "manifest.toml": MANIFEST, "rule.toml": RULE, "street.toml": STREET, "stereo.toml": STEREO, "matlab.toml": STEREO_MATLAB,
        "exact.toml": EXACT, "inverse.toml": EXACT.replace("[vision]\nsky = 0\n", "").replace('[spatial]\nprior = "potts"\nweight = 1.0\n', ""), "blackbody.toml": BLACKBODY, "noise.toml": NOISE, **SPECTRA,
    }  # fmt: skip
    for name, text in texts.items():
        (pool / name).write_text(text)
    for path in sorted((REPOSITORY / "examples").glob("*.toml")):
        (pool / f"ex_{path.name}").write_text(coarse(path.read_text()))
    run = lambda *words: subprocess.run([hadar, *words], cwd=pool, check=True, capture_output=True)  # noqa: E731
    for kind in ["size", "identify", "rule", "range", "air", "simulate", "render", "decompose", "library"]:
        run("init", kind, f"init_{kind}.toml")
        if (pool / "scene.toml").exists():
            (pool / "scene.toml").rename(pool / "init_scene.toml")
    for path in pool.glob("init_*.toml"):
        path.write_text(coarse(path.read_text()).replace("scene/", ""))
    (pool / "left.npy").write_bytes(npy((9, 24, 3), textured(1000)))
    (pool / "right.npy").write_bytes(npy((9, 24, 3), textured(1010)))
    (pool / "cold.npy").write_bytes(npy((4, 4, 3), textured(100)))
    (pool / "warm.npy").write_bytes(npy((4, 4, 3), textured(500)))
    (pool / "depth.npy").write_bytes(npy((9, 24, 1), textured(10)))
    (pool / "exact.npy").write_bytes(npy((6, 8, 15), exact))
    rendered = pool / "rendered"
    run("render", "init_scene.toml", "--out", rendered, "--quiet")
    for path in rendered.iterdir():
        if path.suffix in (".npy", ".csv"):
            shutil.copy(path, pool / path.name)
    scenario = (rendered / "decompose.toml").read_text()
    # Two surroundings are enough, and quicker.
    for column in ("robot", "person"):
        scenario = scenario.replace(f'[[environment]]\nspectrum = "surroundings.csv"\ncolumn = "{column}"\n\n', "")
    scenario = scenario.replace('lighting = ["./lighting.npy"]\n', "")
    (pool / "parts.toml").write_text(scenario)
    shutil.rmtree(rendered)
    # The same cube in other formats.
    with zipfile.ZipFile(pool / "counts.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(pool / "counts.npy", "counts.npy")
    (pool / "npz.toml").write_text(scenario.replace("counts.npy", "counts.npz"))
    run("render", "init_scene.toml", "--out", rendered, "--quiet", "--cube-format", "envi")
    for path in rendered.glob("counts.*"):
        shutil.copy(path, pool / path.name)
    shutil.rmtree(rendered)
    (pool / "envi.toml").write_text(scenario.replace("counts.npy", "counts.hdr"))
    run("render", "init_scene.toml", "--out", rendered, "--quiet", "--layout", "hadar")
    shutil.copy(next((rendered / "HeatCubes").iterdir()), pool / "counts.mat")
    shutil.rmtree(rendered)
    (pool / "mat.toml").write_text(scenario.replace("counts.npy", "counts.mat"))
    run("rule", "rule.toml", "--out", rendered, "--quiet")
    shutil.copy(rendered / "certificate.json", pool / "certificate.json")
    shutil.rmtree(rendered)
    for name, variable in [("a.h5", "cube"), ("b.mat", "S"), ("c.nc", "radiance"), ("d.mat", "S"), ("e.npz", "cube")]:
        (pool / f"{name}.toml").write_text(STEREO_MATLAB.replace("left.mat", name).replace('"S"', f'"{variable}"'))
    seeds = REPOSITORY / "fuzz" / "seeds"
    for seed, name in [
        ("hdf5/h5py_new", "a.h5"), ("hdf5/matlab73", "b.mat"), ("hdf5/netcdf", "c.nc"), ("mat/plain", "left.mat"), ("mat/zlib", "d.mat"),
        ("npz/numpy_packed", "e.npz"), ("model/logistic", "model.json"), ("model/network", "network.json"), ("material/ecostress", "f.txt"),
        ("material/jcamp", "g.jdx"), ("spectral_library/spectral", "h.hdr"), ("optical_constants/brass", "i.yml"),
    ]:  # fmt: skip
        shutil.copy(seeds / seed, pool / name)


FILE_INPUTS = ["files.toml", "my.csv", "two.csv", "air.csv", "filters.csv", "efficiency.csv"]
PARTS = ["surroundings.csv", "library.csv", "material.npy", "temperature_k.npy", "lighting.npy", "surface.npy"]

COMMANDS = [
    (["size", "size.toml"], ["size.toml"]),
    (["size", "size.toml", "--check"], ["size.toml"]),
    (["size", "files.toml"], FILE_INPUTS),
    (["size", "priors.toml"], ["priors.toml", "bands.csv"]),
    (["size", "init_size.toml"], ["init_size.toml"]),
    (["size", "own.toml", "--cameras", "cameras.toml", "--library", "manifest.toml"], ["own.toml", "cameras.toml", "manifest.toml", "my.csv"]),
    (["size", "ex_person_or_robot.toml"], ["ex_person_or_robot.toml"]),
    (["identify", "size.toml"], ["size.toml"]),
    (["identify", "init_identify.toml", "--matrix"], ["init_identify.toml"]),
    (["identify", "files.toml", "--matrix", "--by", "local"], FILE_INPUTS),
    (["identify", "average.toml", "--average"], ["average.toml"]),
    (["identify", "priors.toml", "--exact", "--trials", "64"], ["priors.toml", "bands.csv"]),
    (["identify", "size.toml", "--bands", "2"], ["size.toml"]),
    (["identify", "size.toml", "--filters", "2"], ["size.toml"]),
    (["identify", "own.toml", "--apart", "--cameras", "cameras.toml", "--library", "manifest.toml"], ["own.toml", "cameras.toml", "manifest.toml", "my.csv"]),
    (["simulate", "size.toml", "--spectra", "80"], ["size.toml"]),
    (["simulate", "ex_human_vs_robot_3_bands.toml", "--spectra", "80", "--model", "model.json"], ["model.json", "ex_human_vs_robot_3_bands.toml"]),
    (["simulate", "ex_human_vs_robot_3_bands.toml", "--spectra", "80", "--model", "network.json"], ["network.json", "ex_human_vs_robot_3_bands.toml"]),
    (["simulate", "files.toml", "--thermometry", "20 degC..40 degC", "--temperatures", "2", "--spectra", "20"], FILE_INPUTS),
    (["simulate", "average.toml", "--average", "--spectra", "80"], ["average.toml"]),
    (["rule", "rule.toml"], ["rule.toml", "two.csv"]),
    (["rule", "init_rule.toml"], ["init_rule.toml"]),
    (["rule", "--verify", "certificate.json"], ["certificate.json", "rule.toml", "two.csv"]),
    (["range", "street.toml"], ["street.toml", "my.csv"]),
    (["range", "street.toml", "--trials", "2"], ["street.toml", "my.csv"]),
    (["range", "stereo.toml"], ["stereo.toml", "left.npy", "right.npy", "depth.npy", "noise.csv"]),
    (["range", "matlab.toml"], ["matlab.toml", "left.mat"]),
    (["range", "init_air.toml"], ["init_air.toml"]),
    (["range", "init_air.toml", "--bands", "4"], ["init_air.toml"]),
    (["render", "init_scene.toml"], ["init_scene.toml"]),
    (["render", "ex_night_street.toml", "--no-noise"], ["ex_night_street.toml"]),
    (["decompose", "exact.toml"], ["exact.toml", "exact.npy", "library15.csv"]),
    (["decompose", "exact.toml", "--method", "te"], ["exact.toml", "exact.npy", "library15.csv"]),
    (["decompose", "inverse.toml", "--method", "analytic-inverse"], ["inverse.toml", "exact.npy", "library15.csv"]),
    (["decompose", "parts.toml"], ["parts.toml", "counts.npy", *PARTS]),
    (["decompose", "npz.toml"], ["npz.toml", "counts.npz", *PARTS]),
    (["decompose", "envi.toml"], ["envi.toml", "counts.hdr", "counts.img", *PARTS]),
    (["decompose", "mat.toml"], ["mat.toml", "counts.mat", *PARTS]),
    (["library", "init_library.toml"], ["init_library.toml", "counts.npy", "surroundings.csv"]),
    (["calibrate", "blackbody", "blackbody.toml"], ["blackbody.toml", "cold.npy", "warm.npy", "left.npy"]),
    (["calibrate", "noise", "left.npy", "right.npy"], ["left.npy", "right.npy"]),
    (["calibrate", "stripes", "counts.npy"], ["counts.npy"]),
    (["range", "a.h5.toml"], ["a.h5", "a.h5.toml"]),
    (["range", "b.mat.toml"], ["b.mat", "b.mat.toml"]),
    (["range", "c.nc.toml"], ["c.nc", "c.nc.toml"]),
    (["range", "d.mat.toml"], ["d.mat", "d.mat.toml"]),
    (["range", "e.npz.toml"], ["e.npz", "e.npz.toml"]),
    (["calibrate", "stripes", "counts.hdr"], ["counts.hdr", "counts.img"]),
    (["sweep", "size.toml", "--cases", "cases.csv", "--out", "out"], ["cases.csv", "size.toml", "my.csv"]),
    (["sweep", "size.toml", "--vary", "target.distance=5 m,20 m", "--columns", "verdict", "--out", "out"], ["size.toml"]),
    (["materials", "import", "my.csv", "f.txt", "g.jdx", "h.hdr", "i.yml"], ["my.csv", "f.txt", "g.jdx", "h.hdr", "i.yml"]),
    (["materials", "list", "--library", "manifest.toml"], ["manifest.toml", "my.csv"]),
    (["cameras", "list", "--cameras", "cameras.toml"], ["cameras.toml"]),
]  # fmt: skip
