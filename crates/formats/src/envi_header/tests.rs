use super::*;

const IMAGE: &str = "ENVI\n; written by hand\ndescription = {\n  a cube, {of} mine\n}\nSamples  = 4\nlines=3\nbands   = 2\nheader offset = 16\n\
    file type = ENVI Standard\ndata type = 12\ninterleave = BIP\nbyte order = 1\nWavelength Units = Nanometers\n\
    wavelength = {\n 8000.0, 9000.5\n}\nfwhm = { 10, 12, }\nbbl = {1, 0}\ndata ignore value = -9999\nsensor type =\n\
    band names = {one,\n; between\n two}\n";

#[test]
fn a_header_is_read() {
    let header = EnviHeader::parse(IMAGE).unwrap();
    let layout = Layout {
        samples: 4,
        lines: 3,
        bands: 2,
        data_type: DataType::U16,
        interleave: Interleave::Bip,
        byte_order: ByteOrder::Big,
        header_offset: 16,
    };
    assert_eq!(header.layout(), Ok(layout));
    assert_eq!(layout.bytes(), Some(16 + 4 * 3 * 2 * 2));
    assert_eq!(header.wavelength_unit(), Ok(Some(SpectralUnit::Nanometre)));
    assert_eq!(header.numbers("wavelength"), Ok(Some(vec![8000.0, 9000.5])));
    assert_eq!(header.numbers_for("fwhm", 2, "bands"), Ok(Some(vec![10.0, 12.0])));
    assert_eq!(header.good_bands(2), Ok(Some(vec![true, false])));
    assert_eq!(header.ignored(), Ok(Some(-9999.0)));
    assert_eq!(
        EnviHeader::parse("ENVI\ndata ignore value = NaN\n").map(|header| header.ignored()),
        Ok(Ok(None))
    );
    assert_eq!(header.number("reflectance scale factor"), Ok(None));
    assert_eq!(header.text("sensor type"), None);
    assert_eq!(header.text("description"), Some("a cube, {of} mine"));
    assert_eq!(header.list("band names"), Some(vec!["one", "two"]));
    assert!(!header.is_spectral_library());
    assert_eq!(EnviHeader::parse(&IMAGE.replace('\n', "\r\n")).map(|header| header.layout()), Ok(Ok(layout)));
}

/// Every message has the line and what to write.
#[test]
fn each_mistake_has_its_line() {
    let layout = |header: &EnviHeader| header.layout().map(drop);
    type Ask = fn(&EnviHeader) -> Result<()>;
    let cases: &[(&str, &str, Ask, &str)] = &[
        ("data type = 12", "data type = 6", layout, "line 11: data type: the samples are complex"),
        ("data type = 12", "data type = 7", layout, "line 11: data type: `7` is no type of data; write 1, 2"),
        ("data type = 12\n", "", layout, "the header has no `data type`"),
        ("Samples  = 4", "samples = -4", layout, "line 6: samples: `-4`"),
        ("Samples  = 4", "samples =", layout, "line 6: the header has no `samples`"),
        ("= BIP", "= bpi", layout, "line 12: interleave: `bpi`"),
        ("byte order = 1", "byte order = 2", layout, "line 13: byte order: `2`"),
        ("header offset = 16", "header offset = -1", layout, "line 9: header offset: `-1`"),
        (
            "9000.5",
            "x",
            |header| header.numbers("wavelength").map(drop),
            "line 16: wavelength: `x` is not a finite number",
        ),
        (
            " 12,",
            "",
            |header| header.numbers_for("fwhm", 2, "bands").map(drop),
            "line 18: fwhm: 1 numbers for 2 bands",
        ),
        ("{1, 0}", "{1, 3}", |header| header.good_bands(2).map(drop), "line 19: bbl: `3`"),
        (
            "Nanometers",
            "Furlongs",
            |header| header.wavelength_unit().map(drop),
            "line 14: wavelength units: `Furlongs`",
        ),
    ];
    for (from, to, ask, expected) in cases {
        assert!(IMAGE.contains(from), "{from}");
        let header = EnviHeader::parse(&IMAGE.replace(from, to)).unwrap();
        let message = ask(&header).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
    for (text, expected) in [
        ("ENVY\n", "line 1: the first line is not `ENVI`"),
        ("ENVI\nsamples\n", "line 2: this is no `key = value`"),
        ("ENVI\nsamples = 1\nSAMPLES = 2\n", "line 3: samples: this key is there already on line 2"),
        ("ENVI\nwavelength = {1,\n2\n", "line 2: wavelength: the `{` is not closed"),
        ("ENVI\nwavelength = {1} 2\n", "line 2: wavelength: there is text after"),
    ] {
        let message = EnviHeader::parse(text).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn samples_are_read_in_either_order() {
    let bytes = [1, 2, 0xff];
    assert_eq!(DataType::U8.samples(&bytes, ByteOrder::Big), [1.0, 2.0, 255.0]);
    assert_eq!(DataType::U16.samples(&bytes, ByteOrder::Little), [513.0]);
    assert_eq!(DataType::U16.samples(&bytes, ByteOrder::Big), [258.0]);
    let of = |data_type: DataType, bytes: &[u8]| data_type.samples(bytes, ByteOrder::Big);
    assert_eq!(of(DataType::I16, &(-3_i16).to_be_bytes()), [-3.0]);
    assert_eq!(of(DataType::I32, &(-70_000_i32).to_be_bytes()), [-70_000.0]);
    assert_eq!(of(DataType::U32, &4_000_000_000_u32.to_be_bytes()), [4e9]);
    assert_eq!(of(DataType::I64, &(-5_i64).to_be_bytes()), [-5.0]);
    assert_eq!(of(DataType::U64, &7_u64.to_be_bytes()), [7.0]);
    assert_eq!(of(DataType::F32, &0.25_f32.to_be_bytes()), [0.25]);
    assert_eq!(of(DataType::F64, &0.1_f64.to_be_bytes()), [0.1]);
}

#[test]
fn header_and_data_find_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, "").unwrap();
        path
    };
    let (header, data) = (put("a.hdr"), put("a.bil"));
    assert_eq!((data_of(&header), header_of(&data)), (Ok(data.clone()), Some(header)));
    let (header, data) = (put("b.img.hdr"), put("b.img"));
    assert_eq!((data_of(&header), header_of(&data)), (Ok(data), Some(header)));
    let (header, data) = (put("c.hdr"), put("c"));
    assert_eq!((data_of(&header), header_of(&data)), (Ok(data), Some(header.clone())));
    put("c.img");
    assert!(data_of(&header).unwrap_err().to_string().contains("`c` and `c.img` may both be the data"));
    let alone = put("d.hdr");
    assert!(data_of(&alone).unwrap_err().to_string().contains("not beside it; put them there"));
    assert_eq!(header_of(&put("e.img")), None);
    assert_eq!(header_of(&alone), None);
}

proptest::proptest! {
    #![proptest_config(hadar_testing::seeded(46, 256))]

    #[test]
    fn no_text_makes_the_reader_panic(text in "([a-z={},;0-9 ]|\n|ENVI|data type|wavelength){0,60}") {
        if let Ok(header) = EnviHeader::parse(&format!("ENVI\n{text}")) {
            let _ = (header.layout(), header.numbers("wavelength"), header.good_bands(3), header.list("data type"));
        }
    }
}
