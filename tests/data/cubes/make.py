"""Small cubes as other programs write them: numpy, spectral, scipy, h5py, netCDF4, astropy, tifffile, zarr, fasthcc.

A sample is 100 row + 10 column + band (for signed bytes 120 less) of 3 rows, 4 columns, 5 bands, unless a line says otherwise.
Run in this folder: python make.py
"""

import struct

import fasthcc
import h5py
import netCDF4
import numcodecs
import numpy as np
import scipy.io
import spectral.io.envi as envi
import tifffile
import zarr
from astropy.io import fits

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

# A group of the older kind with a soft link, and one of the newer
for name, libver in [("h5py_links.h5", "earliest"), ("h5py_links_new.h5", "latest")]:
    with h5py.File(name, "w", libver=libver) as f:
        f["radiance"] = CUBE.astype("<f4")
        f["wavelength"] = LISTED_UM
        f["wavelength"].attrs["units"] = "um"
        f["alias"] = h5py.SoftLink("/radiance")
        f["away"] = h5py.ExternalLink("other.h5", "/radiance")
# Wavelengths in a group of their own, with widths and the list of good bands
with netCDF4.Dataset("netcdf_group.nc", "w") as f:
    for name, size in [("downtrack", ROWS), ("crosstrack", COLUMNS), ("bands", BANDS)]:
        f.createDimension(name, size)
    f.createVariable("radiance", "f4", ("downtrack", "crosstrack", "bands"))[:] = CUBE
    group = f.createGroup("sensor_band_parameters")
    for name, values, unit in [
        ("wavelengths", 1000 * LISTED_UM, "nm"),
        ("fwhm", np.full(BANDS, 50.0), "nm"),
        ("good_wavelengths", [1, 1, 0, 1, 1], "1"),
    ]:
        v = group.createVariable(name, "f4", ("bands",))
        v.units = unit
        v[:] = values

# Classic NetCDF: fixed variables and records, in turns with others and alone
for kind in ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA"]:
    with netCDF4.Dataset(kind.lower() + ".nc", "w", format=kind) as f:
        for name, size in [("wavelength", BANDS), ("y", None), ("x", COLUMNS), ("row", ROWS)]:
            f.createDimension(name, size)
        axis = f.createVariable("wavelength", "f8", ("wavelength",))
        axis.units = "um"
        axis[:] = LISTED_UM
        v = f.createVariable("fixed", "i2", ("wavelength", "row", "x"), fill_value=-1)
        v.scale_factor, v.add_offset, v.units = 0.5, -3.0, "W m-2 sr-1 um-1"
        data = np.ma.array(IMAGES)
        data[3, 1, 2] = np.ma.masked
        v[:] = data
        f.createVariable("records", "f4", ("y", "x", "wavelength"))[:] = CUBE
        f.createVariable("odd", "i1", ("y", "x"))[:] = np.arange(ROWS * COLUMNS).reshape(ROWS, COLUMNS)
with netCDF4.Dataset("netcdf3_record_axis.nc", "w", format="NETCDF3_CLASSIC") as f:
    for name, size in [("frequency", None), ("y", ROWS), ("x", COLUMNS)]:
        f.createDimension(name, size)
    axis = f.createVariable("frequency", "f8", ("frequency",))
    axis.units = "THz"
    v = f.createVariable("radiance", "f4", ("frequency", "y", "x"))
    v[:] = IMAGES
    axis[:] = 299.792458 / LISTED_UM
# A packed axis of wavelengths
with netCDF4.Dataset("netcdf3_packed_axis.nc", "w", format="NETCDF3_CLASSIC") as f:
    for name, size in [("wavelength", BANDS), ("y", ROWS), ("x", COLUMNS)]:
        f.createDimension(name, size)
    axis = f.createVariable("wavelength", "i2", ("wavelength",))
    axis.units, axis.scale_factor, axis.add_offset = "um", 0.001, 8.0
    axis[:] = LISTED_UM
    v = f.createVariable("radiance", "i2", ("wavelength", "y", "x"))
    data = np.ma.array(IMAGES)
    data[3, 1, 2] = np.ma.masked
    v[:] = data
with scipy.io.netcdf_file("scipy_records.nc", "w") as f:
    for name, size in [("y", None), ("x", COLUMNS), ("band", BANDS)]:
        f.createDimension(name, size)
    f.createVariable("cube", "i2", ("y", "x", "band"))[:] = CUBE

# astropy: FITS
header = fits.Header()
header["CTYPE3"], header["CUNIT3"], header["BUNIT"] = "WAVE", "um", "W m-2 sr-1 um-1"
header["CRVAL3"], header["CRPIX3"], header["CDELT3"] = 8.0, 1.0, 1.0
fits.writeto("astropy_f4.fits", IMAGES.astype(">f4"), header, overwrite=True)
fits.writeto("astropy_u2.fits", IMAGES.astype("u2"), overwrite=True)
spectral_first = fits.Header()
spectral_first["CTYPE1"], spectral_first["CRVAL1"], spectral_first["CRPIX1"], spectral_first["CD1_1"] = "WAVN", 80000.0, 1.0, 10000.0
numbers = CUBE.astype("i2")
numbers[1, 2, 3] = -32768
hdu = fits.ImageHDU(numbers, spectral_first, name="SCENE")
hdu.header["BLANK"] = -32768
fits.HDUList([fits.PrimaryHDU(), hdu, fits.ImageHDU(CUBE[:, :, 0], name="MAP")]).writeto("astropy_extensions.fits", overwrite=True)
fits.HDUList([fits.PrimaryHDU(), fits.CompImageHDU(IMAGES.astype("i4"))]).writeto("astropy_packed.fits", overwrite=True)

# tifffile: samples and pages, planes, tiles, packed, of either order of bytes
tifffile.imwrite("tiff_samples.tif", CUBE.astype("f4"), photometric="minisblack", planarconfig="contig")
tifffile.imwrite("tiff_planes.tif", IMAGES.astype("u2"), photometric="minisblack", planarconfig="separate", byteorder=">")
tifffile.imwrite("tiff_pages.tif", IMAGES.astype("f8"), photometric="minisblack", compression="zlib", predictor=False, metadata=None)
tifffile.imwrite("tiff_big.tif", CUBE.astype("i2"), bigtiff=True, photometric="minisblack", planarconfig="contig", compression="lzw", tile=(16, 16))
tifffile.imwrite("tiff_pages_gdal.tif", IMAGES.astype("f4"), photometric="minisblack", metadata=None, extratags=[(42113, "s", 0, "11", False)])
tifffile.imwrite("tiff_one.tif", CUBE[:, :, 0].astype("u2"), photometric="minisblack")
tifffile.imwrite("tiff_colours.tif", np.zeros((3, 4, 3), "u1"), photometric="rgb")
items = "".join(
    f'<Item name="SCALE" sample="{i}" role="scale">2</Item><Item name="OFFSET" sample="{i}" role="offset">-1</Item>'
    f'<Item name="UNITTYPE" sample="{i}" role="unittype">W m-2 sr-1 um-1</Item>'
    f'<Item name="CENTRAL_WAVELENGTH_UM" sample="{i}" domain="IMAGERY">{um}</Item><Item name="FWHM_UM" sample="{i}" domain="IMAGERY">0.5</Item>'
    for i, um in enumerate(LISTED_UM)
)
tifffile.imwrite(
    "tiff_gdal.tif",
    ((CUBE + 1) / 2).astype("f4"),
    photometric="minisblack",
    planarconfig="contig",
    extratags=[(42112, "s", 0, f"<GDALMetadata>{items}</GDALMetadata>", True), (42113, "s", 0, "6", True)],
)

# zarr: both versions, every codec, chunks at the border, one that was never written
for version, codec, compressors in [
    (2, "none", None),
    (2, "blosc", numcodecs.Blosc("lz4", shuffle=1, blocksize=256)),
    (2, "zstd", numcodecs.Zstd()),
    (2, "lz4", numcodecs.LZ4()),
    (2, "zlib", numcodecs.Zlib()),
    (3, "none", None),
    (3, "zstd", zarr.codecs.ZstdCodec()),
    (3, "gzip", zarr.codecs.GzipCodec()),
    (3, "blosc", zarr.codecs.BloscCodec(cname="zstd", shuffle="shuffle", typesize=4)),
]:
    a = zarr.create_array(
        f"zarr{version}_{codec}.zarr", shape=CUBE.shape, chunks=(2, 4, 4), dtype="f4", compressors=compressors, zarr_format=version, overwrite=True
    )
    a[:] = CUBE
group = zarr.open_group("zarr_group.zarr", mode="w", zarr_format=2)
cube = group.create_array("radiance", shape=IMAGES.shape, chunks=(5, 2, 4), dtype=">i2", order="F", fill_value=-1, compressors=None)
cube[:, :2] = IMAGES[:, :2]
cube.attrs.update({"_ARRAY_DIMENSIONS": ["wavelength", "y", "x"], "units": "W m-2 sr-1 um-1", "scale_factor": 0.5})
axis = group.create_array("wavelength", shape=(BANDS,), chunks=(BANDS,), dtype="f8", compressors=None)
axis[:] = LISTED_UM
axis.attrs.update({"_ARRAY_DIMENSIONS": ["wavelength"], "units": "um"})

# fasthcc: Telops, temperatures and counts of two frames
HCC = np.array([np.arange(12 * 5).reshape(5, 12), 7 + np.arange(12 * 5).reshape(5, 12)], "u2")
fasthcc.write_hcc("telops_rt.hcc", HCC, data_offset=273.15, data_exp=-8, calibration_mode=2)
fasthcc.write_hcc("telops_raw.hcc", HCC[:1], calibration_mode=0)

# FLIR: blocks as ExifTool describes them (its reading of these files is that of the tests), alone, in a row and in a picture
R1, R2, B, F, O = 17096.453, 0.046642166, 1428.0, 1.0, -342
READINGS = np.array([[14000, 14100, 14200], [15000, 16000, 17000]], "u2")


def block(order, readings, number=0):
    camera = bytearray(0x470)
    struct.pack_into(order + "H", camera, 0, 2)
    struct.pack_into(order + "3f", camera, 0x58, R1, B, F)
    struct.pack_into(order + "if", camera, 0x308, O, R2)
    raw = bytearray(32)
    struct.pack_into(order + "3H", raw, 0, 2, readings.shape[1], readings.shape[0])
    raw += readings.astype(order + "u2").tobytes()
    records = [(1, raw), (0x20, camera)]
    place = 64 + 32 * 3
    lines, content = b"", b""
    for kind, record in records:
        lines += struct.pack(order + "2H6I", kind, 0, 100, 0, place, len(record), 0, 0)[:32].ljust(32, b"\0")
        content += bytes(record)
        place += len(record)
    lines += bytes(32)
    head = b"FFF\0" + b"make".ljust(16, b"\0") + struct.pack(order + "3I", 101, 64, 3)
    return head.ljust(64, b"\0") + lines + content


little = block("<", READINGS)
open("flir.fff", "wb").write(little)
open("flir.seq", "wb").write(little + block("<", READINGS + 100))
big = block(">", READINGS)
parts = [big[:500], big[500:]]
jpeg = b"\xff\xd8"
# The parts in the wrong order, and something else between.
for number in (1, 0):
    content = b"FLIR\0\x01" + bytes([number, 1]) + parts[number]
    jpeg += b"\xff\xe1" + struct.pack(">H", len(content) + 2) + content
    jpeg += b"\xff\xe1" + struct.pack(">H", 8) + b"Exif\0\0"
open("flir.jpg", "wb").write(jpeg + b"\xff\xda\x00\x02\xff\xd9")
open("picture.jpg", "wb").write(b"\xff\xd8\xff\xe0\x00\x04JF\xff\xda\x00\x02\xff\xd9")

# h5py: dimensions of one length by scales that say it, by labels, and by scales of lengths of their own
with h5py.File("h5py_scales.h5", "w") as f:
    square = np.arange(4 * 4 * 7, dtype="u2").reshape(4, 4, 7)
    for name, size in [("band", 4), ("y", 4), ("x", 7), ("lambda", 5), ("rows", 3)]:
        f[name] = np.arange(size, dtype="f4")
        f[name].make_scale(name)
    for name, data, dimensions in [("scaled", square, "band y x"), ("apart", square[:3, 0, :, None].repeat(5, 2), "rows x lambda")]:
        f[name] = data
        for place, scale in enumerate(dimensions.split()):
            f[name].dims[place].attach_scale(f[scale])
    f["labelled"] = square
    for place, label in enumerate(["band", "y", "x"]):
        f["labelled"].dims[place].label = label

# Lists of bands under every name, each beside a cube, and a list that is an attribute of it
with h5py.File("h5py_listed.h5", "w") as f:
    lists = {"Wavelength": "um", "wavelengths_um": None, "band_wavelength": "um", "wl": "um", "nu": "cm-1", "channel": "um", "Lambda_um": ""}
    for name, unit in lists.items():
        group = f.create_group(name.lower())
        group["cube"] = CUBE.astype("<f4")
        group[name] = 1e4 / LISTED_UM if unit == "cm-1" else LISTED_UM
        if unit is not None:
            group[name].attrs["units"] = unit
    f["attribute/cube"] = CUBE.astype("<f4")
    f["attribute/cube"].attrs.update({"wavelength": LISTED_UM, "wavelength_units": "um"})
    for name, unit in [("wavelength", "furlong"), ("band", "1"), ("wavelength_error", "um")]:
        f[f"no_{name}/cube"] = CUBE.astype("<f4")
        f[f"no_{name}/{name}"] = LISTED_UM
        f[f"no_{name}/{name}"].attrs["units"] = unit
# Version 7.3 of MATLAB with what scipy_listed.mat has, and the unit of the samples
with h5py.File("matlab73_listed.mat", "w", userblock_size=512) as f:
    f["S"] = np.transpose(CUBE)
    f["wavelengths_um"] = LISTED_UM[:, None]
    f["units"] = np.frombuffer("microflick".encode("utf-16-le"), "u2")[:, None]
    for name, kind in [("S", "double"), ("wavelengths_um", "double"), ("units", "char")]:
        f[name].attrs["MATLAB_class"] = np.bytes_(kind)
with open("matlab73_listed.mat", "r+b") as f:
    f.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM")

# An array that is not read, beside one that is: shards, four dimensions, a compressed image
group = zarr.open_group("zarr_unread.zarr", mode="w", zarr_format=3)
for name, shards in [("bt", (4, 4)), ("bt_background", None)]:
    one = group.create_array(name, shape=(4, 4), chunks=(2, 2), shards=shards, dtype="f4", compressors=None)
    one[:] = 300.0
    # As xarray says that nothing is missing.
    one.attrs["_FillValue"] = "AAAAAAAA+H8="
with h5py.File("h5py_four.h5", "w") as f:
    f["radiance"] = CUBE[None].astype("<f4")
    f["quality"] = CUBE[:, :, 0].astype("<f4")
images = [fits.PrimaryHDU(), fits.ImageHDU(IMAGES.astype(">f4"), name="RADIANCE"), fits.CompImageHDU(IMAGES.astype(">i2"), name="PACKED")]
fits.HDUList(images).writeto("astropy_packed_beside.fits", overwrite=True)
tifffile.imwrite("tifffile_white.tif", CUBE[:, :, 0].astype("u2"), photometric="miniswhite")

# Factors and offsets that are none of the format's conventions: of the array, of its folder, in an array beside it.
PACKED = CUBE.astype("<i2")
for name, own, outer, beside in [
    ("array", {"Slope": 0.01}, {}, {}),
    ("hdf_eos", {"ScaleFactor": 0.01, "Offset": 300.0}, {}, {}),
    ("folder", {}, {"scale_factor": 0.01}, {}),
    ("beside", {}, {}, {"radiance_scales": np.full(BANDS, 0.01)}),
    ("neutral", {"Slope": 1.0}, {"offset": 0.0}, {"scale": np.float64(1)}),
]:
    with h5py.File(f"packed_{name}.h5", "w") as f:
        group = f.create_group("data")
        group.create_dataset("radiance", data=PACKED).attrs.update(own)
        group.attrs.update(outer)
        for key, value in beside.items():
            group.create_dataset(key, data=value)
    if name == "beside":
        continue
    with netCDF4.Dataset(f"packed_{name}.nc", "w", format="NETCDF3_CLASSIC") as f:
        for side, length in zip(["row", "column", "band"], PACKED.shape):
            f.createDimension(side, length)
        variable = f.createVariable("radiance", "i2", ("row", "column", "band"))
        variable.set_auto_maskandscale(False)
        variable.setncatts(own)
        variable[:] = PACKED
        f.setncatts(outer)
    group = zarr.open_group(f"packed_{name}.zarr", mode="w", zarr_format=3 if name == "folder" else 2)
    array = group.create_array("radiance", shape=PACKED.shape, chunks=PACKED.shape, dtype="<i2", compressors=None)
    array[:] = PACKED
    array.attrs.update(own)
    group.attrs.update(outer)
for name, beside in [("beside", np.full(BANDS, 0.01)), ("neutral", np.float64(1)), ("scalar", np.float64(0.01))]:
    np.savez(f"packed_{name}.npz", radiance=PACKED, scale=beside)
    scipy.io.savemat(f"packed_{name}.mat", {"radiance": PACKED, "radiance_slope": beside})
for name, key, factor in [("array", "radiance scale factor", 100), ("neutral", "scale factor", 1)]:
    envi.save_image(f"packed_{name}.hdr", PACKED, interleave="bil", metadata={key: factor}, force=True)
