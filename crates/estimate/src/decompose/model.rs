//! Mean counts of a pixel as they are linear in its lighting: N = g·A(T) + Σⱼ uⱼ Cⱼ.
//!
//! With N_w = κ_w ∫ [e B(T) + (1 − e) Σₖ Vₖ Sₖ] over band w, A(T) is the emission and Cⱼ what the target scatters under the
//! lighting of *vertex* j: the lightings that are possible are the mixtures of a few of them, uⱼ ≥ 0. Where ΣVₖ ≤ 1 the
//! vertices are darkness and each of the surroundings alone, where ΣVₖ = v is known (S48) each alone with Vₖ = v. A calibrated
//! camera has Σuⱼ = 1 = g; an unknown gain is g = Σuⱼ.
//!
//! | symbol | unit | what |
//! |---|---|---|
//! | κ_w | m² sr s | counts for each unit of the band's signal |
//! | e | | emissivity of the material at the nodes |
//! | T | K | temperature of the target |
//! | Sₖ | photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ | spectrum of the k-th surroundings |
//! | Vₖ | | its thermal lighting factor |
//!
//! Air on the path lets a share τ of all that through and adds its own light, S′ = τ S + P: the factor of κ at the nodes, and a part of
//! every Cⱼ.
//!
//! A(T) is tabulated with its slope and interpolated by cubic Hermite polynomials on steps of h = 0.03 T²/(c₂ν), the least of the
//! range: off by (0.03)⁴/384 = 2e-9 of itself at most. Where each band has one node the table is Planck's law and all
//! materials share it.
//!
//! Source: paper S2, S44, S48.

use super::setting::{Light, MOST_SURROUNDINGS, Setting, check_between};
use hadar::aligned::Aligned;
use hadar::error::{Error, Result, check};
use hadar::planck;
use hadar::scene::check_emissivity;
use hadar::simd::LANES;
use hadar::spectrum::Bands;
use hadar::units::SECOND_RADIATION_CM_K;

/// Step of the table times c₂ν/T².
const STEP: f64 = 0.03;
/// Most temperatures of the table: a range that asks for more would not fit into memory.
const MOST_STEPS: f64 = 2e4;
/// Most unknown numbers: the temperature, and a weight of each vertex.
pub(super) const MOST: usize = MOST_SURROUNDINGS + 2;

/// The tables of a [`Setting`]. Values of bands are padded with zeros to whole chunks.
#[derive(Debug)]
pub(super) struct Model {
    /// Bands that count, as places in a pixel of the cube.
    pub(super) used: Vec<usize>,
    /// Bands that count, with their padding.
    pub(super) width: usize,
    /// Surroundings K.
    pub(super) surroundings: usize,
    /// Vertices J of the lighting.
    pub(super) vertices: usize,
    pub(super) lighting_total: Option<f64>,
    pub(super) gain: bool,
    /// σ²_w; 1 in the padding, so that nothing is divided by 0 there.
    pub(super) var_added: Aligned,
    pub(super) range_k: [f64; 2],
    step_k: f64,
    steps: usize,
    /// Values and slopes times the step: `[table][temperature][value, slope][band]`.
    table: Aligned,
    shared: bool,
    /// Factors of the table for each material.
    factor: Aligned,
    /// C: `[material][vertex][band]`.
    scattered: Aligned,
    /// Cⱼ − C₀ of the vertices but the first: `[material][vertex − 1][band]`.
    changes: Aligned,
    /// What the vertices send themselves: `[vertex][band]`.
    light: Aligned,
    /// Mean emissivity of each material in each band: `[material][band]`.
    emissivity: Aligned,
    /// Mean wavenumber of each band that counts, cm⁻¹.
    pub(super) centres_cm1: Vec<f64>,
}

/// The row of the table at a temperature, and where between it and the next one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) row: usize,
    pub(super) share: f64,
    pub(super) step_k: f64,
}

impl Model {
    pub(super) fn new(setting: &Setting<'_>) -> Result<Self> {
        let Setting { bands, library, surroundings, counts_per_radiance, .. } = *setting;
        let lengths = [
            ("counts per radiance", counts_per_radiance.len()),
            (
                "variances of electronic noise",
                if setting.var_added.is_empty() { bands.len() } else { setting.var_added.len() },
            ),
        ];
        for (what, found) in lengths {
            if found != bands.len() {
                return Err(Error::Length { what: what.into(), found, expected: bands.len() });
            }
        }
        check::each(
            counts_per_radiance,
            |x| x > 0.0 && x.is_finite(),
            |x| check::positive("counts per radiance", x, "m^2 sr s"),
        )?;
        check::each(
            setting.var_added,
            |x| (0.0..f64::INFINITY).contains(&x),
            |x| check::non_negative("variance of electronic noise", x, "counts^2"),
        )?;
        if library.is_empty() {
            return Err(Error::malformed("a library without a material", "give at least one"));
        }
        if library.len() >= usize::from(u16::MAX) || surroundings.len() > MOST_SURROUNDINGS {
            return Err(Error::malformed(
                format!("{} materials and {} surroundings", library.len(), surroundings.len()),
                format!("give fewer than 65535 and at most {MOST_SURROUNDINGS}"),
            ));
        }
        let nodes = bands.nodes_cm1().len();
        library.iter().try_for_each(|e| check_emissivity(e, nodes))?;
        check_between(setting, nodes)?;
        let [low, high] = setting.temperature_k;
        check::positive("temperature", low, "K")?;
        if !(low < high && high.is_finite()) {
            return Err(Error::out_of_range(
                "highest temperature",
                high,
                "K",
                "finite, above the lowest, which is known temperature otherwise",
            ));
        }
        if let Some(total) = setting.lighting_total {
            check::unit_interval("sum of the thermal lighting factors V", total)?;
        }
        let used: Vec<usize> = (0..bands.len()).filter(|band| !setting.bad_bands.contains(band)).collect();
        if used.is_empty() {
            return Err(Error::malformed("every band is a bad one", "leave some in"));
        }
        let width = used.len().next_multiple_of(LANES);
        let known = setting.lighting_total.is_some() && !surroundings.is_empty();
        let vertices = surroundings.len() + usize::from(!known);
        let (_, fastest_cm1) = bands.range_cm1();
        let step = STEP * low * low / (SECOND_RADIATION_CM_K * fastest_cm1);
        let steps = ((high - low) / step).ceil().max(1.0);
        if steps > MOST_STEPS {
            return Err(Error::out_of_range("lowest temperature", low, "K", "nearer to the highest"));
        }
        let mut model = Self {
            width,
            surroundings: surroundings.len(),
            vertices,
            lighting_total: setting.lighting_total.filter(|_| known),
            gain: setting.gain,
            var_added: Aligned::zeros(width),
            range_k: [low, high],
            step_k: (high - low) / steps,
            steps: steps as usize,
            table: Aligned::default(),
            shared: bands.one_node_per_band(),
            factor: Aligned::default(),
            scattered: Aligned::zeros(library.len() * vertices * width),
            changes: Aligned::zeros(library.len() * (vertices - 1) * width),
            light: Aligned::zeros(vertices * width),
            emissivity: Aligned::zeros(library.len() * width),
            centres_cm1: Vec::new(),
            used,
        };
        model.fill(setting)?;
        Ok(model)
    }

    fn fill(&mut self, setting: &Setting<'_>) -> Result<()> {
        let Setting { bands, library, .. } = *setting;
        let widths = bands.widths_cm1();
        self.var_added.fill(1.0);
        let centres = centres_of(bands, &widths);
        for (lane, &band) in self.used.iter().enumerate() {
            self.var_added[lane] = setting.var_added.get(band).copied().unwrap_or(0.0);
            self.centres_cm1.push(centres[band]);
        }
        self.fill_lighting(setting, &widths)?;
        self.fill_table(setting);
        let width = self.width;
        self.factor = Aligned::zeros(library.len() * width);
        for (m, emissivity) in library.iter().enumerate() {
            let mean: Vec<f64> =
                bands.weigh(emissivity).iter().zip(&widths).map(|(e, width)| e / width).collect();
            put(&self.used, &mut self.emissivity[m * width..][..width], &mean);
            let factor = &mut self.factor[m * width..][..width];
            match self.shared {
                true => put(&self.used, factor, emissivity),
                false => factor.fill(1.0),
            }
        }
        Ok(())
    }

    /// What each vertex sends and what each material scatters of it: darkness first if there is one, then each of the surroundings alone.
    fn fill_lighting(&mut self, setting: &Setting<'_>, widths: &[f64]) -> Result<()> {
        let Setting { bands, library, surroundings, light_besides, .. } = *setting;
        let width = self.width;
        let first = self.vertices - surroundings.len();
        let share = self.lighting_total.unwrap_or(1.0);
        for (k, light) in surroundings.iter().enumerate() {
            let (spectrum, expected) = match light {
                Light::Radiance(spectrum) => (spectrum, bands.nodes_cm1().len()),
                Light::Counts(spectrum) => (spectrum, bands.len()),
            };
            if spectrum.len() != expected {
                let what = "spectrum of the surroundings".into();
                return Err(Error::Length { what, found: spectrum.len(), expected });
            }
            check::each(
                spectrum,
                |x| (0.0..f64::INFINITY).contains(&x),
                |x| check::non_negative("spectrum of the surroundings", x, ""),
            )?;
            let alone = match light {
                Light::Radiance(spectrum) => counts(setting, spectrum.iter().copied()),
                Light::Counts(spectrum) => spectrum.clone(),
            };
            let alone: Vec<f64> = alone.iter().map(|n| n * share).collect();
            put(&self.used, &mut self.light[(first + k) * width..][..width], &alone);
            for (m, emissivity) in library.iter().enumerate() {
                let scattered: Vec<f64> = match light {
                    Light::Radiance(spectrum) => {
                        let nodes = spectrum.iter().zip(emissivity.iter());
                        counts(setting, nodes.map(|(s, e)| share * (1.0 - e) * s))
                    }
                    Light::Counts(_) => bands
                        .weigh(emissivity)
                        .iter()
                        .zip(widths)
                        .zip(&alone)
                        .map(|((e, width), n)| (1.0 - e / width) * n)
                        .collect(),
                };
                let to = &mut self.scattered[(m * self.vertices + first + k) * width..][..width];
                put(&self.used, to, &scattered);
            }
        }
        for (m, emissivity) in library.iter().enumerate() {
            // What each vertex has besides: light that is always there, and the air's own.
            let mut besides = vec![0.0; bands.len()];
            if !light_besides.is_empty() {
                let nodes = light_besides.iter().zip(emissivity.iter());
                besides = counts(setting, nodes.map(|(s, e)| (1.0 - e) * s));
            }
            if let Some(path) = setting.path {
                let sent = bands.weigh(&path.radiance);
                let each = besides.iter_mut().zip(sent.iter().zip(setting.counts_per_radiance));
                each.for_each(|(n, (sent, k))| *n += k * sent);
            }
            for own in self.scattered[m * self.vertices * width..][..self.vertices * width].chunks_mut(width)
            {
                own.iter_mut().zip(&self.used).for_each(|(n, band)| *n += besides[*band]);
            }
        }
        if !light_besides.is_empty() {
            let besides = counts(setting, light_besides.iter().copied());
            for own in self.light.chunks_mut(width) {
                own.iter_mut().zip(&self.used).for_each(|(n, band)| *n += besides[*band]);
            }
        }
        for m in 0..library.len() {
            let (first, others) =
                self.scattered[m * self.vertices * width..][..self.vertices * width].split_at(width);
            let to = &mut self.changes[m * (self.vertices - 1) * width..][..others.len()];
            for (i, (to, from)) in to.iter_mut().zip(others).enumerate() {
                *to = from - first[i % width];
            }
        }
        Ok(())
    }

    /// What each material emits at the temperatures of the table; the last table is that of a blackbody, alone where all share it.
    fn fill_table(&mut self, setting: &Setting<'_>) {
        let (library, nodes, width) = (setting.library, setting.bands.nodes_cm1(), self.width);
        let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        let tables = if self.shared { 1 } else { library.len() + 1 };
        self.table = Aligned::zeros(tables * (self.steps + 1) * 2 * width);
        for row in 0..=self.steps {
            let temperature_k = self.temperature_of(row as f64);
            planck::photon_radiance_and_slope_into(nodes, temperature_k, &mut value, &mut slope);
            for table in 0..tables {
                let own = library.get(table).filter(|_| !self.shared);
                let e = |j: usize| own.map_or(1.0, |own| own[j]);
                let at = (table * (self.steps + 1) + row) * 2 * width;
                for (i, (values, factor)) in [(&value, 1.0), (&slope, self.step_k)].into_iter().enumerate() {
                    let emitted = values.iter().enumerate().map(|(j, x)| factor * e(j) * x);
                    put(&self.used, &mut self.table[at + i * width..][..width], &counts(setting, emitted));
                }
            }
        }
    }

    /// Temperature at a row of the table, K.
    pub(super) fn temperature_of(&self, row: f64) -> f64 {
        row.mul_add(self.step_k, self.range_k[0]).min(self.range_k[1])
    }

    /// Temperatures of the table.
    pub(super) fn rows(&self) -> usize {
        self.steps + 1
    }

    pub(super) fn place(&self, temperature_k: f64) -> Place {
        let at = ((temperature_k - self.range_k[0]) / self.step_k).max(0.0);
        let row = (at as usize).min(self.steps - 1);
        Place { row, share: at - row as f64, step_k: self.step_k }
    }

    /// Two rows of the table, each values and slopes, and the factors of material `m`.
    pub(super) fn emission(&self, m: usize, row: usize) -> [&[f64]; 5] {
        let table = if self.shared { 0 } else { m };
        let at = (table * (self.steps + 1) + row) * 2 * self.width;
        let part = |i: usize| &self.table[at + i * self.width..][..self.width];
        [part(0), part(1), part(2), part(3), &self.factor[m * self.width..][..self.width]]
    }

    /// Two rows of the table of a blackbody, each values and slopes.
    pub(super) fn emission_of_blackbody(&self, row: usize) -> [&[f64]; 4] {
        let len = 2 * self.width;
        let last = self.table.len() / ((self.steps + 1) * len) - 1;
        let at = (last * (self.steps + 1) + row) * len;
        std::array::from_fn(|i| &self.table[at + i * self.width..][..self.width])
    }

    /// Counts of a blackbody at a temperature.
    pub(super) fn blackbody(&self, temperature_k: f64) -> Vec<f64> {
        let place = self.place(temperature_k);
        let [a, b, c, d] = Hermite::at(place.share).value;
        let [p, q, r, s] = self.emission_of_blackbody(place.row);
        (0..self.width).map(|w| a * p[w] + b * q[w] + c * r[w] + d * s[w]).collect()
    }

    /// Mean emissivity of material `m` in each band.
    pub(super) fn emissivity(&self, m: usize) -> &[f64] {
        &self.emissivity[m * self.width..][..self.width]
    }

    /// Cⱼ of all vertices of material `m`, one after the other.
    pub(super) fn scattered(&self, m: usize) -> &[f64] {
        let len = self.vertices * self.width;
        &self.scattered[m * len..][..len]
    }

    /// Cⱼ of material `m`.
    pub(super) fn scattered_of(&self, m: usize, j: usize) -> &[f64] {
        &self.scattered(m)[j * self.width..][..self.width]
    }

    /// C₀ of material `m`.
    pub(super) fn base(&self, m: usize) -> &[f64] {
        &self.scattered(m)[..self.width]
    }

    /// What an unknown weight changes of material `m`: Cⱼ of all vertices with an unknown gain, Cⱼ − C₀ of all but the first without.
    pub(super) fn columns(&self, m: usize) -> impl Iterator<Item = &[f64]> {
        let len = (self.vertices - 1) * self.width;
        let changes = match self.gain {
            true => self.scattered(m),
            false => &self.changes[m * len..][..len],
        };
        changes.chunks(self.width)
    }

    /// Unknown numbers, the temperature among them.
    pub(super) fn unknowns(&self) -> usize {
        1 + self.vertices - usize::from(!self.gain)
    }

    /// g of a mixture of the vertices.
    pub(super) fn scale(&self, mixture: &[f64]) -> f64 {
        if self.gain { mixture.iter().sum() } else { 1.0 }
    }

    /// What vertex j sends itself.
    pub(super) fn light(&self, j: usize) -> &[f64] {
        &self.light[j * self.width..][..self.width]
    }

    /// A(T) of material `m`, and its slope per kelvin.
    pub(super) fn emitted(&self, m: usize, temperature_k: f64) -> (Vec<f64>, Vec<f64>) {
        let place = self.place(temperature_k);
        let hermite = Hermite::at(place.share);
        let [v0, s0, v1, s1, factor] = self.emission(m, place.row);
        let mix =
            |[a, b, c, d]: [f64; 4], w: usize| factor[w] * (a * v0[w] + b * s0[w] + c * v1[w] + d * s1[w]);
        let values = (0..self.width).map(|w| mix(hermite.value, w)).collect();
        (values, (0..self.width).map(|w| mix(hermite.slope, w) / place.step_k).collect())
    }

    /// Vₖ of a mixture of vertices.
    pub(super) fn lighting(&self, mixture: &[f64]) -> [f64; MOST_SURROUNDINGS] {
        let total = self.scale(mixture);
        let first = self.vertices - self.surroundings;
        let share = self.lighting_total.unwrap_or(1.0);
        let mut lighting = [0.0; MOST_SURROUNDINGS];
        for (v, u) in lighting.iter_mut().zip(&mixture[first..]) {
            *v = share * u / total;
        }
        lighting
    }

    /// Slopes of Σₖ aₖVₖ with the weights of the vertices.
    pub(super) fn slopes_of_lighting(&self, a: &[f64], mixture: &[f64]) -> [f64; MOST] {
        let scale = self.scale(mixture);
        let share = self.lighting_total.unwrap_or(1.0);
        let mut slopes = [0.0; MOST];
        for (slope, a) in slopes[self.vertices - self.surroundings..self.vertices].iter_mut().zip(a) {
            *slope = share * a / scale;
        }
        if self.gain {
            let all: f64 = slopes.iter().zip(mixture).map(|(slope, u)| slope * u).sum();
            slopes[..self.vertices].iter_mut().for_each(|slope| *slope -= all / scale);
        }
        slopes
    }
}

/// Photon counts of each band of a spectrum at the nodes, behind the air.
fn counts(setting: &Setting<'_>, signal: impl Iterator<Item = f64>) -> Vec<f64> {
    let through = |i: usize| setting.path.map_or(1.0, |path| path.transmittance[i]);
    let signal: Vec<f64> = signal.enumerate().map(|(i, s)| through(i) * s).collect();
    let weighed = setting.bands.weigh(&signal);
    weighed.iter().zip(setting.counts_per_radiance).map(|(s, k)| s * k).collect()
}

/// The values of the bands that are used.
fn put(used: &[usize], to: &mut [f64], from: &[f64]) {
    for (to, &band) in to.iter_mut().zip(used) {
        *to = from[band];
    }
}

/// Mean wavenumber of each band.
fn centres_of(bands: &Bands, widths: &[f64]) -> Vec<f64> {
    bands.weigh(bands.nodes_cm1()).iter().zip(widths).map(|(sum, width)| sum / width).collect()
}

/// Cubic Hermite polynomials at a share of a step: of values and slopes at both ends, and their derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hermite {
    pub(super) value: [f64; 4],
    pub(super) slope: [f64; 4],
}

impl Hermite {
    pub(super) fn at(x: f64) -> Self {
        let y = 1.0 - x;
        Self {
            value: [(1.0 + 2.0 * x) * y * y, x * y * y, x * x * (3.0 - 2.0 * x), -x * x * y],
            slope: [-6.0 * x * y, y * (1.0 - 3.0 * x), 6.0 * x * y, x * (3.0 * x - 2.0)],
        }
    }
}
