//! What is kept of every pixel: in memory, or in files where that would be too much.

use hadar::cube::Shape;
use hadar::error::Result;
use hadar_estimate::decompose::Maps;
use hadar_formats::cube::NpyRows;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Pixels that are worked, or read again, at once by each thread, and by all of them.
const WORKED: usize = 1 << 17;
const MOST_WORKED: usize = 1 << 20;

/// Where the maps of all pixels are kept.
#[derive(Debug, Clone, Copy)]
pub enum Keep<'a> {
    /// In memory.
    InMemory,
    /// In files in a folder, so many rows worked at once. What needs all pixels together (a prior over the image, categories, a
    /// distilled texture) is kept in memory all the same.
    InFiles {
        /// The folder; the files have the names of those of the report.
        folder: &'a Path,
        /// Rows.
        rows: usize,
    },
}

impl<'a> Keep<'a> {
    /// In files in `folder`, with as many rows at once as are well shared among the threads.
    #[must_use]
    pub fn in_files(folder: &'a Path, shape: Shape) -> Self {
        let pixels = (WORKED * rayon::current_num_threads()).clamp(2 * WORKED, MOST_WORKED);
        Self::InFiles { folder, rows: (pixels / shape.columns()).max(1) }
    }
}

/// What is kept of whole rows of pixels.
#[derive(Debug, Clone, Default)]
pub struct Block {
    /// The first row.
    pub first: usize,
    /// What was found.
    pub maps: Maps,
    /// Texture X, photons s⁻¹ m⁻² sr⁻¹; NaN where the lighting is unknown.
    pub texture: Vec<f32>,
    /// Thermal image, photons s⁻¹ m⁻² sr⁻¹; NaN where a sample is missing.
    pub thermal: Vec<f32>,
}

impl Block {
    /// Adds every `stride`th row and column of another one.
    fn add(&mut self, from: &Self, columns: usize, stride: usize) {
        fn each<T: Copy>(to: &mut Vec<T>, from: &[T], columns: usize, stride: usize) {
            to.extend(from.chunks(columns).step_by(stride).flat_map(|row| row.iter().step_by(stride)));
        }
        each(&mut self.maps.material, &from.maps.material, columns, stride);
        each(&mut self.maps.temperature_k, &from.maps.temperature_k, columns, stride);
        each(&mut self.maps.temperature_sigma_k, &from.maps.temperature_sigma_k, columns, stride);
        each(&mut self.maps.candidates, &from.maps.candidates, columns, stride);
        each(&mut self.maps.flags, &from.maps.flags, columns, stride);
        each(&mut self.maps.p_value, &from.maps.p_value, columns, stride);
        each(&mut self.texture, &from.texture, columns, stride);
        each(&mut self.thermal, &from.thermal, columns, stride);
    }
}

/// The maps of all pixels.
#[derive(Debug, Clone)]
pub enum Kept {
    /// All of them.
    InMemory(Box<Block>),
    /// In files, in blocks.
    InFiles(Arc<MapFiles>),
}

impl Kept {
    /// Hands on all rows in their order, a block at a time. In blocks from files lighting, posteriors and the deviations of
    /// lighting and texture are empty.
    ///
    /// # Errors
    /// Files that cannot be read; what `take` refuses.
    pub fn each(&self, take: &mut dyn FnMut(&Block) -> Result<()>) -> Result<()> {
        match self {
            Self::InMemory(block) => take(block),
            Self::InFiles(files) => {
                let rows = files.shape.rows();
                (0..rows)
                    .step_by(files.height)
                    .try_for_each(|first| take(&files.read(first..rows.min(first + files.height))?))
            }
        }
    }

    /// Every `stride`th row and column of a cube of so many rows and columns, without lighting, posteriors and the deviations of lighting and texture.
    ///
    /// # Errors
    /// Files that cannot be read.
    pub fn every(&self, stride: usize, shape: Shape) -> Result<Block> {
        let mut shown = Block::default();
        match self {
            Self::InMemory(block) => shown.add(block, shape.columns(), stride),
            Self::InFiles(files) => {
                for row in (0..shape.rows()).step_by(stride) {
                    shown.add(&files.read(row..row + 1)?, shape.columns(), stride);
                }
            }
        }
        Ok(shown)
    }
}

/// Maps in files, with the names that they have in a report.
#[derive(Debug)]
pub struct MapFiles {
    shape: Shape,
    /// Rows of a block.
    height: usize,
    material: NpyRows<u16>,
    candidates: NpyRows<u16>,
    flags: NpyRows<u8>,
    temperature_k: NpyRows<f32>,
    temperature_sigma_k: NpyRows<f32>,
    lighting: NpyRows<f32>,
    lighting_sigma: NpyRows<f32>,
    p_value: NpyRows<f32>,
    posterior: NpyRows<f32>,
    /// Where that is asked.
    none_of_these: Option<NpyRows<f32>>,
    /// Likewise: probability, share, temperatures and their deviations of two surfaces, and their materials.
    mixed: Option<([NpyRows<f32>; 4], NpyRows<u16>)>,
    candidates_k: NpyRows<u16>,
    candidates_k_posterior: NpyRows<f32>,
    texture: NpyRows<f32>,
    texture_sigma: NpyRows<f32>,
    thermal: NpyRows<f32>,
}

impl MapFiles {
    /// Files in `folder` for so many surroundings and most probable materials, and for what is none of them or two of them if that is
    /// asked; `height` rows in a block.
    pub(super) fn create(
        folder: &Path,
        height: usize,
        shape: Shape,
        (surroundings, ranked, [none_of_these, mixed]): (usize, usize, [bool; 2]),
    ) -> Result<Self> {
        let size = [shape.rows(), shape.columns()];
        let map = |name: &str| NpyRows::create(&folder.join(name), &size);
        let deep = |layers: usize| [size[0], size[1], layers];
        let lit = |name: &str| NpyRows::create(&folder.join(name), &deep(surroundings));
        Ok(Self {
            shape,
            height: height.max(1),
            material: NpyRows::create(&folder.join("material.npy"), &size)?,
            candidates: NpyRows::create(&folder.join("candidates.npy"), &size)?,
            flags: NpyRows::create(&folder.join("flags.npy"), &size)?,
            temperature_k: map("temperature_k.npy")?,
            temperature_sigma_k: map("temperature_sigma_k.npy")?,
            lighting: lit("lighting.npy")?,
            lighting_sigma: lit("lighting_sigma.npy")?,
            p_value: map("p_value.npy")?,
            posterior: map("posterior.npy")?,
            none_of_these: none_of_these.then(|| map("none_of_these.npy")).transpose()?,
            mixed: mixed
                .then(|| {
                    let two = |name: &str| NpyRows::create(&folder.join(name), &deep(2));
                    let [_, share, temperature, sigma] = MIXED;
                    let reals = [map(MIXED[0])?, two(share)?, two(temperature)?, two(sigma)?];
                    Ok((reals, NpyRows::create(&folder.join(MIXED_MATERIALS), &deep(2))?))
                })
                .transpose()?,
            candidates_k: NpyRows::create(&folder.join("candidates_k.npy"), &deep(ranked))?,
            candidates_k_posterior: NpyRows::create(
                &folder.join("candidates_k_posterior.npy"),
                &deep(ranked),
            )?,
            texture: map("texture.npy")?,
            texture_sigma: map("texture_sigma.npy")?,
            thermal: map("thermal.npy")?,
        })
    }

    pub(super) fn put(&self, block: &Block) -> Result<()> {
        let Block { first, maps, texture, thermal } = block;
        self.material.write(*first, &maps.material)?;
        self.candidates.write(*first, &maps.candidates)?;
        self.candidates_k.write(*first, &maps.ranked)?;
        self.flags.write(*first, &maps.flags)?;
        self.none_of_these.as_ref().map_or(Ok(()), |file| file.write(*first, &maps.other))?;
        if let Some((reals, materials)) = &self.mixed {
            materials.write(*first, &maps.mixed_material)?;
            reals.iter().zip(mixed_layers(maps)).try_for_each(|(file, values)| file.write(*first, values))?;
        }
        for (file, values) in [
            (&self.temperature_k, &maps.temperature_k),
            (&self.temperature_sigma_k, &maps.temperature_sigma_k),
            (&self.lighting, &maps.lighting),
            (&self.lighting_sigma, &maps.lighting_sigma),
            (&self.p_value, &maps.p_value),
            (&self.posterior, &maps.posterior),
            (&self.candidates_k_posterior, &maps.ranked_posterior),
            (&self.texture, texture),
            (&self.texture_sigma, &maps.texture_sigma),
            (&self.thermal, thermal),
        ] {
            file.write(*first, values)?;
        }
        Ok(())
    }

    fn read(&self, rows: Range<usize>) -> Result<Block> {
        let of = |file: &NpyRows<f32>| file.read(rows.clone());
        Ok(Block {
            first: rows.start,
            maps: Maps {
                material: self.material.read(rows.clone())?,
                candidates: self.candidates.read(rows.clone())?,
                flags: self.flags.read(rows.clone())?,
                temperature_k: of(&self.temperature_k)?,
                temperature_sigma_k: of(&self.temperature_sigma_k)?,
                p_value: of(&self.p_value)?,
                ..Maps::default()
            },
            texture: of(&self.texture)?,
            thermal: of(&self.thermal)?,
        })
    }

    /// Where they are, in the order of the report.
    #[must_use]
    pub fn paths(&self) -> Vec<&Path> {
        let all = [
            self.material.path(),
            self.temperature_k.path(),
            self.temperature_sigma_k.path(),
            self.lighting.path(),
            self.lighting_sigma.path(),
            self.p_value.path(),
            self.posterior.path(),
            self.candidates.path(),
            self.candidates_k.path(),
            self.candidates_k_posterior.path(),
            self.flags.path(),
            self.texture.path(),
            self.texture_sigma.path(),
            self.thermal.path(),
        ];
        let mixed = self.mixed.iter().flat_map(|(reals, materials)| {
            reals.iter().map(NpyRows::path).chain(std::iter::once(materials.path()))
        });
        all.into_iter().chain(self.none_of_these.as_ref().map(NpyRows::path)).chain(mixed).collect()
    }
}

/// Files of what a pixel is as two surfaces: the probability of that, then of each pixel the share of the first and its deviation,
/// both temperatures, K, and their deviations.
pub const MIXED: [&str; 4] =
    ["mixed.npy", "mixed_share.npy", "mixed_temperature_k.npy", "mixed_temperature_sigma_k.npy"];
/// The two materials.
pub const MIXED_MATERIALS: &str = "mixed_materials.npy";

/// What is in the files of [`MIXED`].
#[must_use]
pub fn mixed_layers(maps: &Maps) -> [&[f32]; 4] {
    [&maps.mixed, &maps.mixed_share, &maps.mixed_temperature_k, &maps.mixed_temperature_sigma_k]
}
