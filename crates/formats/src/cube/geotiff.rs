//! TIFF and GeoTIFF pictures: samples of one page, or pages of one sample each, which are its bands.
//!
//! What GDAL says beside the picture is used: the number for nothing (tag 42113), and in its metadata (tag 42112) by band scale, offset, unit, central
//! wavelength and width. Reduced copies of a page are passed over. Pictures in colours are refused.
//!
//! Sources: TIFF Revision 6.0 (Adobe, 1992); GDAL, 'GTiff', 'Raster Data Model' (domain IMAGERY).

mod said;

use self::said::{Said, damaged};
use super::axes::Axes;
use super::choice::one_of_frames;
use super::found::{Found, Opened};
use super::image::Image;
use super::raw::MAX_INFLATION;
use super::stored::Stored;
use super::values::{ALL_VALID, Values};
use hadar::error::{Error, Result};
use std::fs::File;
use std::io::{BufReader, Seek};
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

/// Pages that are looked at.
const MOST: usize = 100_000;

/// A page: its size, and its samples.
#[derive(Debug)]
struct Page {
    rows: usize,
    columns: usize,
    samples: usize,
    /// Whether each sample has a plane of its own.
    planes: bool,
    stored: Stored,
    numbers: Vec<f64>,
}

/// Opens a file whose first bytes have been seen.
pub(super) fn open(file: File, name: Option<&str>, axes: Option<Axes>) -> Result<Opened> {
    let len = file.metadata().map_err(damaged)?.len();
    let mut source = BufReader::new(file);
    source.rewind().map_err(damaged)?;
    let mut decoder = Decoder::new(source).map_err(damaged)?;
    let most = usize::try_from(len.saturating_mul(MAX_INFLATION)).unwrap_or(usize::MAX);
    let mut limits = Limits::default();
    (limits.decoding_buffer_size, limits.intermediate_buffer_size) = (most, most);
    decoder = decoder.with_limits(limits);
    // Reduced copies and masks are no pages of their own.
    let mut pages = Vec::new();
    for number in 0..MOST {
        if number > 0 {
            if !decoder.more_images() {
                break;
            }
            decoder.next_image().map_err(damaged)?;
        }
        if decoder.find_tag_unsigned::<u32>(Tag::NewSubfileType).map_err(damaged)?.unwrap_or(0) & 0b101 == 0 {
            pages.push(number);
        }
    }
    if name.is_some() && pages.len() == 1 {
        return Err(Error::malformed("the file has one page, which has no name", "leave the variable out"));
    }
    let chosen: Vec<usize> = match name {
        Some(name) => vec![pages.get(one_of_frames(Some(name), pages.len())?).copied().unwrap_or(0)],
        None => pages,
    };
    let mut read: Vec<Page> = Vec::new();
    let mut said: Vec<Said> = Vec::new();
    for number in &chosen {
        hadar::stop::check();
        decoder.seek_to_image(*number).map_err(damaged)?;
        let page = page(&mut decoder, len)?;
        said.push(Said::of(&mut decoder, page.samples)?);
        let fits = |first: &Page| {
            (first.rows, first.columns, first.samples, first.stored)
                == (page.rows, page.columns, 1, page.stored)
        };
        if read.first().is_some_and(|first| !fits(first)) {
            let found =
                format!("the file has {} pages of several sizes, types or numbers of samples", chosen.len());
            return Err(Error::malformed(found, "name one by its number from 0 as the variable"));
        }
        read.push(page);
    }
    let count = read.len();
    let Some(first) = read.first() else { return Err(damaged("it has no page")) };
    let (rows, columns, bands) = (first.rows, first.columns, first.samples.max(count));
    let (stored, planes) = (first.stored, first.planes || count > 1);
    let (sides, own) = match (bands, planes) {
        (1, _) => (vec![rows, columns], Axes::default()),
        (_, true) => (vec![bands, rows, columns], Axes::IMAGES),
        _ => (vec![rows, columns, bands], Axes::default()),
    };
    if let Some(axes) = axes.filter(|axes| *axes != own) {
        let found = format!("axes = \"{axes}\" of a TIFF picture");
        return Err(Error::malformed(found, format!("leave axes out: they are \"{own}\" by its tags")));
    }
    let shape = own.shape(&sides)?;
    let said = Said::of_pages(said)?;
    let list = |list: Vec<f64>| (list.len() == bands).then_some(list);
    let values = Values::new(list(said.scale), list(said.offset), said.missing, ALL_VALID);
    let format = if count > 1 { "TIFF, pages as bands" } else { "TIFF" };
    let numbers = read.into_iter().flat_map(|page| page.numbers).collect();
    let opened = Image { format, shape, order: own, stored, numbers, values }.opened(&[])?;
    let variable = name.map(str::to_owned);
    let found = Found {
        variable,
        unit: said.unit,
        centres_cm1: list(said.centres_cm1),
        widths_cm1: list(said.widths_cm1),
        axis_without_unit: said.axis_unused,
        ..opened.found
    };
    Ok(Opened { found, ..opened })
}

/// The page that the decoder is at.
fn page(decoder: &mut Decoder<BufReader<File>>, len: u64) -> Result<Page> {
    let (width, height) = decoder.dimensions().map_err(damaged)?;
    // The decoder turns their numbers round, as for a picture to be looked at.
    if decoder.find_tag_unsigned::<u16>(Tag::PhotometricInterpretation).map_err(damaged)? == Some(0) {
        return Err(Error::malformed(
            "the picture has white for 0 (PhotometricInterpretation 0), and programs differ in what its numbers are",
            "write it with black for 0: tifffile.imwrite('cube.tif', a, photometric='minisblack')",
        ));
    }
    let color = decoder.colortype().map_err(damaged)?;
    let (bits, samples) = match color {
        ColorType::Gray(bits) => (bits, 1),
        ColorType::GrayA(bits) => (bits, 2),
        ColorType::Multiband { bit_depth, num_samples } => (bit_depth, usize::from(num_samples)),
        // Programs call any three samples so; of eight bits they are colours.
        ColorType::RGB(bits) if bits > 8 => (bits, 3),
        ColorType::RGBA(bits) if bits > 8 => (bits, 4),
        other => {
            return Err(Error::malformed(
                format!("the samples are colours ({other:?}), which say no temperature"),
                "give the picture of readings; if they are bands write them as such: tifffile.imwrite('cube.tif', a, photometric='minisblack')",
            ));
        }
    };
    if bits < 8 {
        return Err(Error::malformed(
            format!("samples of {bits} bits"),
            "write them as whole numbers of 8 or 16 bits",
        ));
    }
    let (rows, columns) = (height as usize, width as usize);
    let layout = decoder.image_buffer_layout().map_err(damaged)?;
    if layout.complete_len as u64 > len.saturating_mul(MAX_INFLATION) {
        return Err(damaged("it announces more samples than it can stand for"));
    }
    let mut result = DecodingResult::U8(Vec::new());
    let layout = decoder.read_image_to_buffer(&mut result).map_err(damaged)?;
    let (numbers, stored) = numbers(result);
    if numbers.len() != rows * columns * samples {
        return Err(damaged(format!(
            "{} samples where {rows} x {columns} x {samples} are due",
            numbers.len()
        )));
    }
    Ok(Page { rows, columns, samples, planes: layout.planes > 1, stored, numbers })
}

fn numbers(result: DecodingResult) -> (Vec<f64>, Stored) {
    fn of<T: Copy + Into<f64>>(numbers: &[T]) -> Vec<f64> {
        numbers.iter().map(|number| (*number).into()).collect()
    }
    match result {
        DecodingResult::U8(numbers) => (of(&numbers), Stored::U8),
        DecodingResult::U16(numbers) => (of(&numbers), Stored::U16),
        DecodingResult::U32(numbers) => (of(&numbers), Stored::U32),
        DecodingResult::U64(numbers) => (numbers.iter().map(|number| *number as f64).collect(), Stored::U64),
        DecodingResult::I8(numbers) => (of(&numbers), Stored::I8),
        DecodingResult::I16(numbers) => (of(&numbers), Stored::I16),
        DecodingResult::I32(numbers) => (of(&numbers), Stored::I32),
        DecodingResult::I64(numbers) => (numbers.iter().map(|number| *number as f64).collect(), Stored::I64),
        DecodingResult::F16(numbers) => (numbers.iter().map(|number| number.to_f64()).collect(), Stored::F16),
        DecodingResult::F32(numbers) => (of(&numbers), Stored::F32),
        DecodingResult::F64(numbers) => (numbers, Stored::F64),
    }
}
