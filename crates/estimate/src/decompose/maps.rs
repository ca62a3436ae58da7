//! A whole cube: rows in parallel, each read, decomposed and put into the maps.
//!
//! Every pixel is for itself, but for a prior over the image ([`super::spatial`]), so the maps are the same for any number of threads
//! and of rows that are worked at once, and only these are in memory.

use super::alike::Alike;
use super::library_error::{Errors, LibraryError, Other};
use super::mixed::{Mixed, Mixture};
use super::model::Model;
use super::pixel::{ANY_LIGHTING, NO_MATERIAL, Pixel, Room, Spared, Task, flag};
use super::possible::{ANYTHING, Members, Possible};
use super::ranked::MOST_RANKED;
use super::screen::Screen;
use super::setting::{MOST_SURROUNDINGS, Setting};
use super::spatial::{Kept, KeptRow, Spatial, SpatialPrior};
use hadar::cube::{CubeRef, Rows, Sample};
use hadar::demand::Skipping;
use hadar::error::{Error, Result};
use hadar::parallel;
use std::ops::Range;

/// How a cube is decomposed, besides its [`Setting`].
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Prior probability of each material, in any scale; empty for equal ones.
    pub prior: Vec<f64>,
    /// How wrong the library may be; exact if silent.
    pub library_error: Option<LibraryError>,
    /// Prior probability that a surface is none of the library, with an emissivity that is smooth; taken for impossible if silent.
    pub other: Option<f64>,
    /// Prior probability that a pixel holds two surfaces of the library, a tenth of it each at least; taken for impossible if silent.
    pub mixed: Option<f64>,
    /// What all pixels are off by alike: deviations of what the whole cube shares hold it.
    pub alike: Alike,
    /// Whether materials that a bound excludes are left out; the answer is the same.
    pub skipping: Skipping,
    /// What neighbours tell about a pixel; each is for itself if silent.
    pub spatial: Option<SpatialPrior>,
    /// The categories of each material, a bit each ([`super::possible`]); empty where none are asked for.
    pub categories: Vec<u64>,
    /// How many of the most probable materials of a pixel are kept, at most [`MOST_RANKED`].
    pub ranked: usize,
}

/// What is found of every pixel, `[row][column]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Maps {
    /// [`Pixel::material`].
    pub material: Vec<u16>,
    /// [`Pixel::temperature_k`].
    pub temperature_k: Vec<f32>,
    /// [`Pixel::sigma_k`].
    pub temperature_sigma_k: Vec<f32>,
    /// [`Pixel::lighting`], `[row][column][surroundings]`.
    pub lighting: Vec<f32>,
    /// [`Pixel::lighting_sigma`], likewise.
    pub lighting_sigma: Vec<f32>,
    /// [`Pixel::texture_sigma`].
    pub texture_sigma: Vec<f32>,
    /// [`Pixel::p_value`].
    pub p_value: Vec<f32>,
    /// [`Pixel::posterior`].
    pub posterior: Vec<f32>,
    /// [`Pixel::other`]; empty where that is not asked.
    pub other: Vec<f32>,
    /// [`Mixture::probability`](super::Mixture); empty where that is not asked, as all of it.
    pub mixed: Vec<f32>,
    /// Its materials, `[row][column][part]`.
    pub mixed_material: Vec<u16>,
    /// The share of the first, and its deviation.
    pub mixed_share: Vec<f32>,
    /// Temperature of each part, K, `[row][column][part]`.
    pub mixed_temperature_k: Vec<f32>,
    /// Their deviations, K.
    pub mixed_temperature_sigma_k: Vec<f32>,
    /// [`Pixel::ranked`], `[row][column][rank]`.
    pub ranked: Vec<u16>,
    /// Their posteriors, likewise.
    pub ranked_posterior: Vec<f32>,
    /// [`Pixel::candidates`].
    pub candidates: Vec<u16>,
    /// [`Pixel::flags`].
    pub flags: Vec<u8>,
    /// [`Possible::at_95`]; empty without categories, and by methods without a likelihood.
    pub possible_95: Vec<u64>,
    /// [`Possible::common_95`], likewise.
    pub common_95: Vec<u64>,
    /// [`Possible::at_99`], likewise.
    pub possible_99: Vec<u64>,
    /// Shares of the categories in the posterior by the counts of the pixel alone, `[row][column][category]`; NaN where anything is possible.
    pub category_shares: Vec<f32>,
    /// What was spared.
    pub spared: Spared,
    /// What a prior over the image did, if there was one.
    pub spatial: Option<Spatial>,
}

/// How many rows are worked at once, and who is given their maps, with the first of the rows: one block after the other.
pub(super) type Blocks<'a> = (usize, &'a mut dyn FnMut(usize, Maps) -> Result<()>);

/// By maximum likelihood.
pub(super) fn likeliest(
    setting: &Setting<'_>,
    options: &Options,
    cube: CubeRef<'_>,
    blocks: Blocks<'_>,
    done: &(dyn Fn(usize) + Sync),
) -> Result<()> {
    check_bands(setting, cube)?;
    match cube {
        CubeRef::F32(rows) => whole(setting, options, rows, blocks, done),
        CubeRef::F64(rows) => whole(setting, options, rows, blocks, done),
    }
}

pub(super) fn check_bands(setting: &Setting<'_>, cube: CubeRef<'_>) -> Result<()> {
    let (found, expected) = (cube.shape().bands(), setting.bands.len());
    if found != expected {
        return Err(Error::Length { what: "bands of the cube".into(), found, expected });
    }
    Ok(())
}

fn whole<S: Sample>(
    setting: &Setting<'_>,
    options: &Options,
    cube: &dyn Rows<S>,
    blocks: Blocks<'_>,
    done: &(dyn Fn(usize) + Sync),
) -> Result<()> {
    options.spatial.as_ref().map_or(Ok(()), |prior| prior.check(options.library_error.is_some()))?;
    if options.spatial.is_some() && (options.other.is_some() || options.mixed.is_some()) {
        let found = "surfaces of none of the materials, or of two, beside a prior over the image, which knows only one of them a pixel";
        return Err(Error::malformed(found, "leave one of them out"));
    }
    if options.mixed.is_some() && (options.library_error.is_some() || setting.gain) {
        let found = "two surfaces in a pixel, with errors of the library or a gain of each pixel";
        return Err(Error::malformed(found, "leave one of them out"));
    }
    let model = Model::new(setting)?;
    let per_unit = 1.0 / setting.units_per_count;
    let signed = is_signed(&model);
    let task = Task::new(model, setting, options)?;
    let by_rows = ByRows { cube, signed, done };
    let pixel =
        |room: &mut Room, sample: &[S], same: Option<Pixel>, spared: &mut Spared, kept: &mut KeptRow| {
            if let Some(same) = same.filter(|_| task.skip && options.spatial.is_none()) {
                spared.equal += setting.library.len() as u64;
                task.share(None, kept);
                return same;
            }
            task.load(sample, per_unit, room);
            let pixel = task.pixel(room, spared);
            task.share(Some((&pixel, &room.shares)), kept);
            if options.spatial.is_some() {
                task.keep(&pixel, room, kept);
            }
            pixel
        };
    let layers = Layers {
        surroundings: setting.surroundings.len(),
        categories: task.members.is_some(),
        ranked: options.ranked,
        other: options.other.is_some(),
        mixed: options.mixed.is_some(),
    };
    let Some(prior) = &options.spatial else {
        return by_rows.in_blocks(blocks, || task.room(), pixel, layers);
    };
    let rows = by_rows.rows(0..cube.shape().rows(), &|| task.room(), &pixel, &|pixels| pixels)?;
    let spared = rows.iter().fold(Spared::default(), |sum, (_, spared, _)| sum + *spared);
    let (pixels, kept): (Vec<Vec<Pixel>>, Vec<KeptRow>) =
        rows.into_iter().map(|(pixels, _, kept)| (pixels, kept)).unzip();
    let shares = kept.iter().flat_map(|row| row.shares.iter().copied()).collect();
    let (mut pixels, kept) = (pixels.concat(), Kept::of_rows(kept));
    let (more, about) = prior.apply(&task, &kept, &mut pixels, (cube, per_unit))?;
    let mut maps = Maps::of(&pixels, layers);
    (maps.spared, maps.spatial, maps.category_shares) = (spared + more, Some(about), shares);
    blocks.1(0, maps)
}

/// What the maps of pixels have of each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layers {
    pub(super) surroundings: usize,
    /// Whether there are sets of categories.
    pub(super) categories: bool,
    pub(super) ranked: usize,
    /// Whether a surface of none of the materials is asked for.
    pub(super) other: bool,
    /// Whether two surfaces in a pixel are asked for.
    pub(super) mixed: bool,
}

/// Whether all bands have noise added, so that samples may come out below 0.
pub(super) fn is_signed(model: &Model) -> bool {
    model.var_added[..model.used.len()].iter().all(|var| *var > 0.0)
}

/// A cube of which every pixel is for itself.
pub(super) struct ByRows<'a, S> {
    pub(super) cube: &'a dyn Rows<S>,
    /// Whether samples may be below 0.
    pub(super) signed: bool,
    /// Is told how many rows are finished.
    pub(super) done: &'a (dyn Fn(usize) + Sync),
}

/// What is kept of the pixels of a row, what was spared in it, and what is kept of it besides.
type Row<P> = (P, Spared, KeptRow);

impl<S: Sample> ByRows<'_, S> {
    /// The maps of what `pixel` makes of every pixel ([`Self::rows`]), some rows at a time.
    pub(super) fn in_blocks<R: Send>(
        &self,
        (height, take): Blocks<'_>,
        room: impl Fn() -> R + Sync,
        pixel: impl Fn(&mut R, &[S], Option<Pixel>, &mut Spared, &mut KeptRow) -> Pixel + Sync,
        layers: Layers,
    ) -> Result<()> {
        let rows = self.cube.shape().rows();
        let height = height.clamp(1, rows);
        for first in (0..rows).step_by(height) {
            let block = first..rows.min(first + height);
            let block = self.rows(block, &room, &pixel, &|pixels| Maps::of(&pixels, layers))?;
            take(first, Maps::joined(block))?;
        }
        Ok(())
    }

    /// What `pixel` makes of the samples of every pixel of some rows, with room of its own for each thread. It is given the pixel before in the
    /// row where that has the same samples: dead, dark and saturated regions do. Of a row that is done, only what `keep` makes of
    /// it is kept.
    fn rows<R: Send, P: Send>(
        &self,
        rows: Range<usize>,
        room: &(impl Fn() -> R + Sync),
        pixel: &(impl Fn(&mut R, &[S], Option<Pixel>, &mut Spared, &mut KeptRow) -> Pixel + Sync),
        keep: &(impl Fn(Vec<Pixel>) -> P + Sync),
    ) -> Result<Vec<Row<P>>> {
        let shape = self.cube.shape();
        let is_count = |n: f64| n >= 0.0 || n.is_nan();
        let of_row = |(room, buffer): &mut (R, Vec<S>), row: usize| {
            let samples = self.cube.read(row..row + 1, buffer)?;
            let negative_at = || samples.iter().position(|sample| !is_count((*sample).into()));
            if !self.signed
                && let Some(at) = negative_at()
            {
                let place = (row, at / shape.bands(), at % shape.bands());
                return Err(negative(samples[at].into(), place));
            }
            let (mut spared, mut kept) = (Spared::default(), KeptRow::default());
            let mut pixels: Vec<Pixel> = Vec::with_capacity(shape.columns());
            let mut before = None;
            for sample in samples.chunks(shape.bands()) {
                let same = pixels.last().copied().filter(|_| before == Some(sample));
                pixels.push(pixel(room, sample, same, &mut spared, &mut kept));
                before = Some(sample);
            }
            (self.done)(1);
            Ok((keep(pixels), spared, kept))
        };
        let start = rows.start;
        parallel::try_map_with(rows.len(), || (room(), Vec::new()), |own, i| of_row(own, start + i))
    }
}

fn negative(value: f64, (row, column, band): (usize, usize, usize)) -> Error {
    Error::malformed(
        format!("row {row}, column {column}, band {band} holds {value}, which is no number of counts"),
        "give counts from 0, NaN for those that are missing, or the noise that makes them negative",
    )
}

impl Task {
    fn new(model: Model, setting: &Setting<'_>, options: &Options) -> Result<Self> {
        let materials = setting.library.len();
        let prior = match options.prior.len() {
            0 => vec![1.0; materials],
            found if found == materials => options.prior.clone(),
            found => {
                return Err(Error::Length { what: "prior probabilities".into(), found, expected: materials });
            }
        };
        if let Some(wrong) = prior.iter().find(|p| !(**p > 0.0 && p.is_finite())) {
            return Err(Error::out_of_range("prior probability", *wrong, "", "above 0"));
        }
        let (mut kinds, mut alike, mut kind_of): (Vec<usize>, Vec<usize>, Vec<usize>) = Default::default();
        for m in 0..materials {
            let same =
                |&first: &usize| setting.library[first] == setting.library[m] && prior[first] == prior[m];
            match kinds.iter().position(same) {
                Some(kind) => {
                    alike[kind] += 1;
                    kind_of.push(kind);
                }
                None => {
                    kind_of.push(kinds.len());
                    kinds.push(m);
                    alike.push(1);
                }
            }
        }
        let most = prior.iter().copied().fold(0.0, f64::max);
        let handicap: Vec<f64> = kinds.iter().map(|&m| -2.0 * libm::log(prior[m] / most)).collect();
        let errors = options.library_error.map(|error| Errors::new(&model, error)).transpose()?;
        let largest = errors.as_ref().map_or(0.0, |errors| errors.largest);
        let screen = (!model.gain).then(|| Screen::new(&model, &kinds, largest));
        let single = 1.0 - options.other.unwrap_or(0.0) - options.mixed.unwrap_or(0.0);
        let other = options.other.map(|p| Other::new(setting, [p, single], &prior)).transpose()?;
        let library = (&*kinds, &*prior, &*alike);
        let mixed =
            options.mixed.map(|p| Mixed::new(&model, screen.as_ref(), library, [p, single])).transpose()?;
        let members = Members::new(&options.categories, &kind_of, &alike, &handicap)?;
        let (textures, skip) = (setting.textures(), options.skipping.skips());
        Ok(Self {
            errors,
            other,
            mixed,
            model,
            screen,
            members,
            kinds,
            alike,
            kind_of,
            textures,
            handicap,
            skip,
        })
    }

    /// Keeps the shares of the categories of a pixel, or those of the pixel before once more.
    fn share(&self, of: Option<(&Pixel, &Vec<f32>)>, kept: &mut KeptRow) {
        let Some(Members { count, .. }) = self.members else { return };
        match of {
            Some((pixel, shares)) if pixel.possible != Possible::ANYTHING => kept.shares.extend(shares),
            Some(_) => kept.shares.extend(std::iter::repeat_n(f32::NAN, count)),
            None => kept.shares.extend_from_within(kept.shares.len().saturating_sub(count)..),
        }
    }
}

impl Maps {
    /// Whether pixel i, counted row after row, has one material left that fits, at a temperature within its range: at an end of it another
    /// material might fit better beyond.
    #[must_use]
    pub fn is_decided(&self, i: usize) -> bool {
        let flags = self.flags.get(i).copied().unwrap_or(flag::SKIPPED);
        self.candidates.get(i) == Some(&1)
            && self.material.get(i).is_some_and(|material| *material != NO_MATERIAL)
            && flags & (flag::NO_FIT | flag::TEMPERATURE_AT_LIMIT) == 0
    }

    /// The categories that pixel i may be of; anything where that is not known.
    #[must_use]
    pub fn possible(&self, i: usize) -> Possible {
        let of = |sets: &[u64]| sets.get(i).copied().unwrap_or(ANYTHING);
        Possible {
            at_95: of(&self.possible_95),
            common_95: of(&self.common_95),
            at_99: of(&self.possible_99),
        }
    }

    /// Takes out the lighting factors that are not told, by the deviations that the maps have by now ([`super::widen`]), where their sum is
    /// known as in the setting. Until then they are those of the fit, which the model is judged by.
    pub fn leave_out_unknown_lighting(&mut self, lighting_total: Option<f64>) {
        let lights = self.lighting.len() / self.material.len().max(1);
        let most = (ANY_LIGHTING * lighting_total.unwrap_or(1.0)) as f32;
        let each = self.lighting.chunks_mut(lights.max(1)).zip(self.lighting_sigma.chunks_mut(lights.max(1)));
        let pixels = self.flags.iter_mut().zip(&mut self.texture_sigma);
        for ((flags, of_texture), (lighting, sigma)) in pixels.zip(each) {
            if *flags & flag::LIGHTING_UNKNOWN != 0 || sigma.iter().any(|sigma| *sigma > most) {
                *flags |= flag::LIGHTING_UNKNOWN;
                lighting.fill(f32::NAN);
                sigma.fill(f32::NAN);
                *of_texture = f32::NAN;
            }
        }
    }

    /// The materials, [`NO_MATERIAL`] also where none of the library fits.
    #[must_use]
    pub fn fitting_material(&self) -> Vec<u16> {
        let one =
            |(material, flags): (&u16, &u8)| if flags & flag::NO_FIT == 0 { *material } else { NO_MATERIAL };
        self.material.iter().zip(&self.flags).map(one).collect()
    }

    /// The maps of rows, one below the other.
    fn joined(rows: Vec<Row<Self>>) -> Self {
        let mut all = Self::default();
        for (row, spared, kept) in rows {
            all.material.extend(row.material);
            all.temperature_k.extend(row.temperature_k);
            all.temperature_sigma_k.extend(row.temperature_sigma_k);
            all.lighting.extend(row.lighting);
            all.lighting_sigma.extend(row.lighting_sigma);
            all.texture_sigma.extend(row.texture_sigma);
            all.p_value.extend(row.p_value);
            all.posterior.extend(row.posterior);
            all.other.extend(row.other);
            all.mixed.extend(row.mixed);
            all.mixed_material.extend(row.mixed_material);
            all.mixed_share.extend(row.mixed_share);
            all.mixed_temperature_k.extend(row.mixed_temperature_k);
            all.mixed_temperature_sigma_k.extend(row.mixed_temperature_sigma_k);
            all.ranked.extend(row.ranked);
            all.ranked_posterior.extend(row.ranked_posterior);
            all.candidates.extend(row.candidates);
            all.flags.extend(row.flags);
            all.possible_95.extend(row.possible_95);
            all.common_95.extend(row.common_95);
            all.possible_99.extend(row.possible_99);
            all.category_shares.extend(kept.shares);
            all.spared = all.spared + spared;
        }
        all
    }

    fn of(pixels: &[Pixel], layers: Layers) -> Self {
        let Layers { surroundings, categories, ranked, other, mixed } = layers;
        let all = || pixels.iter();
        let possible = |of: fn(&Possible) -> u64| -> Vec<u64> {
            if categories { all().map(|p| of(&p.possible)).collect() } else { Vec::new() }
        };
        let lights = surroundings.min(MOST_SURROUNDINGS);
        let lit = |of: fn(&Pixel) -> &[f64; MOST_SURROUNDINGS]| -> Vec<f32> {
            all().flat_map(|p| of(p)[..lights].iter().map(|v| *v as f32)).collect()
        };
        let ranks = ranked.min(MOST_RANKED);
        let of_two = |of: fn(&Mixture) -> [f64; 2]| -> Vec<f32> {
            let each = || all().flat_map(|p| of(&p.mixed)).map(|x| x as f32);
            if mixed { each().collect() } else { Vec::new() }
        };
        Self {
            material: all().map(|p| p.material).collect(),
            temperature_k: all().map(|p| p.temperature_k as f32).collect(),
            temperature_sigma_k: all().map(|p| p.sigma_k as f32).collect(),
            lighting: lit(|p| &p.lighting),
            lighting_sigma: lit(|p| &p.lighting_sigma),
            texture_sigma: all().map(|p| p.texture_sigma as f32).collect(),
            p_value: all().map(|p| p.p_value as f32).collect(),
            posterior: all().map(|p| p.posterior as f32).collect(),
            other: if other { all().map(|p| p.other as f32).collect() } else { Vec::new() },
            mixed: if mixed { all().map(|p| p.mixed.probability as f32).collect() } else { Vec::new() },
            mixed_material: if mixed { all().flat_map(|p| p.mixed.materials).collect() } else { Vec::new() },
            mixed_share: of_two(|two| two.share),
            mixed_temperature_k: of_two(|two| two.temperature_k),
            mixed_temperature_sigma_k: of_two(|two| two.sigma_k),
            ranked: all().flat_map(|p| p.ranked.materials[..ranks].iter().copied()).collect(),
            ranked_posterior: all().flat_map(|p| p.ranked.posteriors[..ranks].iter().copied()).collect(),
            candidates: all().map(|p| p.candidates).collect(),
            flags: all().map(|p| p.flags).collect(),
            possible_95: possible(|one| one.at_95),
            common_95: possible(|one| one.common_95),
            possible_99: possible(|one| one.at_99),
            ..Self::default()
        }
    }
}
