"""Small cubes as other programs write them: numpy, spectral, scipy, h5py, netCDF4.

A sample is 100 row + 10 column + band (for signed bytes 120 less) of 3 rows, 4 columns, 5 bands, unless a line says otherwise.
Run in this folder: python make.py
"""

import h5py
import netCDF4
import numpy as np
import scipy.io
import spectral.io.envi as envi

ROWS, COLUMNS, BANDS = 3, 4, 5
r, c, b = np.meshgrid(np.arange(ROWS), np.arange(COLUMNS), np.arange(BANDS), indexing="ij")
CUBE = (100 * r + 10 * c + b).astype(np.float64)
IMAGES = np.moveaxis(CUBE, 2, 0)  # [band][row][column]


def typed(dtype):
    return (CUBE - 120 if np.dtype(dtype) == np.int8 else CUBE).astype(dtype)


# NumPy: every type, both orders of bytes and of the array
for dtype in ["?", "i1", "u1", "<i2", ">u2", ">i4", "<u4", "<i8", ">u8", "<f2", ">f4", "<f8"]:
    name = dtype.strip("<>").replace("?", "bool")
    np.save(f"numpy_{name}.npy", (CUBE % 2).astype(bool) if dtype == "?" else typed(dtype))
np.save("numpy_fortran.npy", np.asfortranarray(CUBE.astype("<f4")))
np.save("numpy_fortran_u2be.npy", np.asfortranarray(CUBE.astype(">u2")))
np.save("numpy_bands_first.npy", IMAGES.astype("<u2"))
np.save("numpy_bands_first_fortran.npy", np.asfortranarray(IMAGES.astype("<f8")))
np.save("numpy_columns_first.npy", np.moveaxis(CUBE, 0, 1).astype("<f4"))
np.save("numpy_complex.npy", CUBE.astype("<c8"))
np.savez("numpy_stored.npz", cube=CUBE.astype("<f4"), label=np.arange(3.0), names=np.array(["a"]))
np.savez_compressed("numpy_packed.npz", cube=CUBE.astype(">i2"), flat=np.zeros((2, 2)))
LISTED_UM = np.linspace(8.0, 12.0, BANDS)
np.savez("numpy_listed.npz", cube=CUBE.astype("<f4"), wavelengths_um=LISTED_UM.astype(">f4"))
np.savez_compressed("numpy_listed_packed.npz", cube=CUBE.astype("<f4"), wavenumber_cm1=1e4 / LISTED_UM, wavelength_nm=np.zeros(9))
np.savez("numpy_listed_without_unit.npz", cube=CUBE.astype("<f4"), wavelength=LISTED_UM)
np.savez_compressed("numpy_two.npz", left=np.asfortranarray(CUBE), right=-CUBE)

# spectral: interleaves, types, orders of bytes
META = {
    "wavelength": [12.5, 10.0, 9.0, 8.5, 8.0],
    "wavelength units": "Micrometers",
    "fwhm": [0.5, 0.4, 0.3, 0.2, 0.1],
    "bbl": [1, 1, 0, 1, 0],
}
for interleave, dtype, order in [
    ("bsq", "f4", 0),
    ("bil", "f4", 0),
    ("bip", "f4", 0),
    ("bsq", "i2", 1),
    ("bil", "f8", 1),
    ("bip", "u2", 1),
    ("bil", "u1", 0),
    ("bsq", "i4", 0),
    ("bip", "u4", 1),
    ("bil", "i8", 0),
    ("bsq", "u8", 1),
]:
    envi.save_image(
        f"envi_{interleave}_{dtype}_{order}.hdr",
        CUBE.astype(dtype),
        dtype=dtype,
        interleave=interleave,
        byteorder=order,
        metadata=META,
        force=True,
    )
# Numbers for nothing, gains and offsets by band: sample = gain (number) + offset is CUBE again but where it was ignored.
gain, offset = np.array([0.5, 1, 2, 4, 0.25]), np.array([0, 1, -2, 3, 4])
numbers = (CUBE - offset) / gain
numbers[1, 2, 3] = -9999
envi.save_image(
    "envi_scaled.hdr",
    numbers,
    dtype="f8",
    interleave="bil",
    metadata={
        "data ignore value": -9999,
        "data gain values": list(gain),
        "data offset values": list(offset),
        "wavelength": [700, 800, 900, 1000, 1100],
        "wavelength units": "Wavenumber",
    },
    force=True,
)
envi.save_image(
    "envi_reflectance.hdr",
    (100 * CUBE).astype("u2"),
    dtype="u2",
    interleave="bsq",
    metadata={"reflectance scale factor": 100},
    force=True,
)

# SciPy: version 5 of MATLAB
scipy.io.savemat("scipy_plain.mat", {"S": CUBE})
scipy.io.savemat("scipy_packed.mat", {"HSI": CUBE.astype("u2"), "map": CUBE[:, :, 0]}, do_compression=True)
scipy.io.savemat("scipy_listed.mat", {"wavelengths_nm": (1000 * LISTED_UM).astype("u2"), "S": CUBE})
scipy.io.savemat("scipy_listed_packed.mat", {"S": CUBE, "wavelength_um": LISTED_UM[:, None]}, do_compression=True)
scipy.io.savemat("scipy_listed_without_unit.mat", {"S": CUBE, "wavelengths": LISTED_UM})
scipy.io.savemat("scipy_bands_first.mat", {"S": IMAGES.astype("f4")})

# h5py: HDF5
with h5py.File("h5py.h5", "w") as f:
    f["plain"] = CUBE.astype(">f4")
    f.create_dataset("packed", data=CUBE.astype(">i2"), chunks=(2, 3, 5), compression="gzip", shuffle=True)
    f.create_dataset("night/images", data=IMAGES.astype("<u4"), chunks=(2, 2, 3), compression="gzip")
    f.create_dataset("night/lines", data=np.moveaxis(CUBE, 2, 1), chunks=(1, 5, 4), compression="lzf")
    f["half"] = CUBE.astype("<f2")
    f["truth"] = CUBE % 2 == 1
    f["complex"] = CUBE.astype("<c16")
    f["text"] = "a heat cube"
with h5py.File("h5py_new.h5", "w", libver=("v110", "v110")) as f:
    f.create_dataset("cube", data=CUBE.astype("<f8"), chunks=(1, 4, 5), compression="gzip", fletcher32=True)
# As MATLAB writes version 7.3: a block of its own before the file, dimensions the other way round.
with h5py.File("matlab73.mat", "w", userblock_size=512) as f:
    plain = f.create_dataset("S", data=np.transpose(CUBE))
    packed = f.create_dataset("P", data=np.transpose(CUBE).astype("<f4"), chunks=(5, 4, 3), compression="gzip")
    for one, name in [(plain, "double"), (packed, "single")]:
        one.attrs["MATLAB_class"] = np.bytes_(name)
with open("matlab73.mat", "r+b") as f:
    f.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM")

# netCDF4: [band][y][x] as such files have them, packed into whole numbers
with netCDF4.Dataset("netcdf.nc", "w") as f:
    for name, size in [("wavelength", BANDS), ("y", ROWS), ("x", COLUMNS)]:
        f.createDimension(name, size)
    axis = f.createVariable("wavelength", "f4", ("wavelength",))
    axis.units = "um"
    axis[:] = META["wavelength"]
    v = f.createVariable("radiance", "i2", ("wavelength", "y", "x"), zlib=True, fill_value=-1)
    v.scale_factor, v.add_offset = 0.5, -3.0
    data = np.ma.array(IMAGES)
    data[3, 1, 2] = np.ma.masked
    v[:] = data
    f.createVariable("never", "f4", ("y", "x", "wavelength"))
    partly = f.createVariable("partly", "f4", ("y", "x", "wavelength"), chunksizes=(1, COLUMNS, BANDS))
    partly[0] = CUBE[0]

# What attributes say of samples: ranges that are valid, units, and texts and lists where one number is due.
with h5py.File("h5py_said.h5", "w") as f:
    said = {
        "valid_max": {"valid_max": np.int16(220)},
        "valid_range": {"valid_range": np.array([10, 220], "i2"), "scale_factor": 0.5, "add_offset": 2.0},
        "valid_unpacked": {"valid_range": np.array([7.0, 112.0]), "scale_factor": 0.5, "add_offset": 2.0},
        "kelvin": {"units": "K"},
        "scale_text": {"scale_factor": "0.1"},
        "scale_list": {"scale_factor": np.array([1.0, 2.0, 3.0])},
        "range_of_one": {"valid_range": np.array([10], "i2")},
    }
    for name, attributes in said.items():
        f.create_dataset(f"{name}/cube", data=CUBE.astype("<i2"))
        f[f"{name}/cube"].attrs.update(attributes)
with h5py.File("h5py_scale_text.h5", "w") as f:
    f["S"] = CUBE.astype("<i2")
    f["S"].attrs["scale_factor"] = "0.1"

# Dimensions by name, in every order that has one; images as wide as high, and as many bands as rows.
with netCDF4.Dataset("netcdf_dimensions.nc", "w") as f:
    for name, size in [("lambda", BANDS), ("y", ROWS), ("x", COLUMNS)]:
        f.createDimension(name, size)
    for name, order in [("a", (2, 0, 1)), ("b", (0, 2, 1)), ("c", (0, 1, 2)), ("d", (1, 0, 2)), ("e", (2, 1, 0))]:
        v = f.createVariable(name, "u2", [("y", "x", "lambda")[axis] for axis in order])
        v[:] = np.transpose(CUBE, order)
    axis = f.createVariable("lambda", "f8", ("lambda",))
    axis.units = "um"
    axis[:] = META["wavelength"]
    square = f.createGroup("square")
    square.createDimension("side_a", 4)
    square.createDimension("bands", 4)
    square.createDimension("columns", 7)
    square.createVariable("s", "f4", ("bands", "side_a", "columns"))[:] = np.ones((4, 4, 7))
