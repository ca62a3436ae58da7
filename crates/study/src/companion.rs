//! What sizing practice says of a camera before a target, beside what is proved: rules of thumb, observer models, the bound.
//!
//! They answer different questions. Rules and observer models know size and contrast, not what a thing is made of: in a scene at
//! one temperature, where nothing can be told from anything, their ranges are what they always are. The bound knows materials, not
//! shape. What is not known is no number, with the reason.
//!
//! Formulas and sources: [`hadar::policy::practice`]; the bound is that of the nearest distance.

mod measure;
mod results;

pub use measure::{Caveat, Kind, Measure, Unknown};
pub use results::{Companion, CompanionRow, Condition};

use super::Study;
use super::identify::PairResult;
use hadar::error::{Result, check};
use hadar::identifiability::detection;
use hadar::instrument::Camera;
use hadar::policy::practice::observer::Law;
use hadar::policy::practice::resolution::{BACKGROUND_K, PERCEPTION, Transfer, mrtd_k, netd_k};
use hadar::policy::practice::{ObserverTask, PIXELS_PER_CYCLE, Subtense};
use hadar::spectrum::Bands;

/// What a companion table is made of. What is not given makes rows without numbers.
#[derive(Debug, Clone, Copy)]
pub struct Given<'a> {
    /// The camera.
    pub camera: Option<&'a Camera>,
    /// Bands, as the camera receives them.
    pub bands: &'a Bands,
    /// Critical dimension of the target: the side of a square one, m.
    pub size_m: Option<f64>,
    /// Its distance, m.
    pub distance_m: Option<f64>,
    /// What the camera tells at that distance.
    pub told: Option<Told<'a>>,
}

/// What a pixel tells at most.
#[derive(Debug, Clone, Copy)]
pub struct Told<'a> {
    /// What is there.
    pub target: &'a str,
    /// What it is to be told from.
    pub alternative: &'a str,
    /// Statistical distance of one pixel, in all bands and frames, by the nearest distance.
    pub statistical_distance: f64,
    /// Pixels of an object, where the distance is that of all of them together.
    pub pixels: Option<f64>,
}

impl Study {
    /// The companion table of the scenario's camera, with what it tells of a pair. `size_m` is the critical dimension where
    /// target.size does not say it, m.
    ///
    /// # Errors
    /// As [`Companion::of`].
    ///
    /// ```
    /// use hadar::material::Library;
    /// use hadar_scenario::Scenario;
    /// use hadar_study::Study;
    ///
    /// let text = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\ndistance = \"30 m\"\n\
    ///             [alternatives]\nmaterials = [\"aluminium\"]\n[camera]\npreset = \"flir-a325sc\"";
    /// let study = Study::new(&Scenario::from_toml(text, None)?, &Library::embedded()?)?;
    /// let found = study.identify()?;
    /// // 0.5 m at 30 m, 12 um behind 18 mm.
    /// let companion = study.companion(&found.pairs[0], Some(0.5))?;
    /// assert!((companion.rows[0].value("pixels").unwrap() - 25.0).abs() < 1e-9);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn companion(&self, pair: &PairResult, size_m: Option<f64>) -> Result<Companion> {
        let told = |statistical_distance| Told {
            target: &pair.target,
            alternative: &pair.alternative,
            statistical_distance,
            pixels: self.pixels_of_object(self.scenario.target.distance_m),
        };
        Companion::of(&Given {
            camera: self.camera.as_ref(),
            bands: &self.bands,
            size_m: self.scenario.target.size_m.or(size_m),
            distance_m: self.scenario.target.distance_m,
            told: pair.statistical_distance_nearest.map(told),
        })
    }
}

impl Study {
    /// Pixels of the object at a distance; `None` where the verdict is of one pixel.
    pub(crate) fn pixels_of_object(&self, distance_m: Option<f64>) -> Option<f64> {
        let camera = self.camera.as_ref().filter(|_| self.scenario.is_of_object())?;
        Some(self.extent(camera, distance_m).pixels())
    }
}

impl Companion {
    /// The table.
    ///
    /// # Errors
    /// A size or distance that is not positive and finite.
    pub fn of(given: &Given<'_>) -> Result<Self> {
        let seen = Seen::of(given)?;
        let tasks = ObserverTask::ALL;
        let mut rows = vec![seen.pixels()];
        rows.extend(seen.pixels_by_field_of_view());
        rows.extend(tasks.map(|task| seen.johnson_range(task)));
        rows.extend(tasks.into_iter().filter_map(|task| seen.industry_range(task)));
        rows.push(seen.netd());
        rows.extend(tasks.map(|task| seen.probability(task)));
        rows.extend(tasks.map(|task| seen.resolvable(task)));
        // Of an object nothing is known of one pixel of it.
        rows.extend(given.told.is_none_or(|told| told.pixels.is_none()).then(|| seen.material()));
        rows.push(seen.material_of_all_pixels());
        Ok(Self {
            camera: given.camera.map(|camera| camera.name.clone()),
            size_m: given.size_m,
            distance_m: given.distance_m,
            rows,
        })
    }
}

/// A number, or why there is none.
type Known<T> = std::result::Result<T, Unknown>;

/// What is given, and what follows from it.
struct Seen<'a> {
    given: &'a Given<'a>,
    subtense: Known<Subtense>,
    /// Pixels across the target at its distance.
    across: Known<f64>,
    /// NETD, K, and what is left of contrast.
    fine: Known<(f64, Transfer)>,
}

impl<'a> Seen<'a> {
    fn of(given: &'a Given<'a>) -> Result<Self> {
        let positive =
            |name, value: Option<f64>| value.map(|value| check::positive(name, value, "m")).transpose();
        let size_m = positive("size of the target", given.size_m)?;
        let distance_m = positive("distance of the target", given.distance_m)?;
        let subtense = match (given.camera, size_m) {
            (None, _) => Err(Unknown::NoCamera),
            (Some(_), None) => Err(Unknown::NoSize),
            (Some(camera), Some(size_m)) => Subtense::of(camera, size_m).map_err(|_| Unknown::BeyondNumbers),
        };
        let across = match (subtense, distance_m) {
            (Err(unknown), _) => Err(unknown),
            (Ok(_), None) => Err(Unknown::NoDistance),
            (Ok(subtense), Some(distance_m)) => {
                let pixels = subtense.pixels(distance_m);
                if pixels.is_normal() { Ok(pixels) } else { Err(Unknown::BeyondNumbers) }
            }
        };
        let fine = match given.camera {
            None => Err(Unknown::NoCamera),
            Some(camera) => {
                let netd = netd_k(camera, BACKGROUND_K)?;
                let transfer = Transfer::of(camera, given.bands)?;
                if netd.is_finite() { Ok((netd, transfer)) } else { Err(Unknown::NoLight) }
            }
        };
        Ok(Self { given, subtense, across, fine })
    }

    fn pixels(&self) -> CompanionRow {
        let mut row = CompanionRow::new(Measure::PixelsOnTarget, None);
        if let Some(camera) = self.given.camera {
            row = row.under("focal_length_m", camera.focal_length_m).under("pixel_m", camera.pixel_m);
        }
        row.with(self.across.map(pixels_and_cycles))
    }

    /// The same by field of view and number of pixels, where that contradicts focal length and pixel.
    fn pixels_by_field_of_view(&self) -> Option<CompanionRow> {
        let camera = self.given.camera?;
        let (view_rad, field) = camera.view_and_pixels().filter(|_| camera.contradicts_its_view())?;
        let pixel_rad = camera.pixel_m / camera.focal_length_m;
        let row = CompanionRow::new(Measure::PixelsByFieldOfView, None)
            .under("field_of_view_rad", view_rad)
            .under("pixels_across_field", field);
        Some(row.with(self.across.map(|pixels| pixels_and_cycles(pixels * pixel_rad / (view_rad / field)))))
    }

    fn johnson_range(&self, task: ObserverTask) -> CompanionRow {
        let cycles = task.johnson_cycles();
        CompanionRow::new(Measure::JohnsonRange, Some(task))
            .under("cycles", cycles)
            .under("cycles_spread", task.johnson_spread_cycles())
            .under("probability", 0.5)
            .with(self.subtense.map(|subtense| vec![subtense.range_of_cycles_m(cycles)]))
    }

    fn industry_range(&self, task: ObserverTask) -> Option<CompanionRow> {
        let pixels = task.industry_pixels()?;
        let row = CompanionRow::new(Measure::IndustryRange, Some(task)).under("pixels", pixels);
        Some(row.with(self.subtense.map(|subtense| vec![subtense.range_m(pixels)])))
    }

    fn netd(&self) -> CompanionRow {
        let mut row = CompanionRow::new(Measure::Netd, None);
        if let Some(camera) = self.given.camera {
            let [low, high] = camera.spectral_range_cm1;
            row = row
                .under("blackbody_k", BACKGROUND_K)
                .under("low_cm1", low)
                .under("high_cm1", high)
                .under("f_number", camera.f_number)
                .under("exposure_s", camera.exposure_s)
                .under("frames", 1.0);
        }
        row.with(self.fine.map(|(netd, _)| vec![netd]))
    }

    fn probability(&self, task: ObserverTask) -> CompanionRow {
        let needed = task.johnson_cycles();
        let cycles = self.across.map(|pixels| pixels / PIXELS_PER_CYCLE);
        let mut row = CompanionRow::new(Measure::Ttpf, Some(task)).under("cycles_for_half", needed);
        if let Ok(cycles) = cycles {
            row = row.under("cycles", cycles);
        }
        row.with(cycles.map(|cycles| vec![Law::Ttpf.probability(cycles / needed)]))
    }

    /// MRTD at the frequency that puts the cycles of a task across the target.
    fn resolvable(&self, task: ObserverTask) -> CompanionRow {
        let cycles = task.johnson_cycles();
        let row = CompanionRow::new(Measure::Mrtd, Some(task))
            .under("perception", PERCEPTION)
            .under("cycles", cycles);
        let Some(camera) = self.given.camera else { return row.with(Err(Unknown::NoCamera)) };
        let (pixels, (netd, transfer)) = match (self.across, self.fine) {
            (Ok(pixels), Ok(fine)) => (pixels, fine),
            (Err(unknown), _) | (_, Err(unknown)) => return row.with(Err(unknown)),
        };
        // Over the target's width in the image.
        let frequency = cycles / (pixels * camera.pixel_m);
        let per_mrad = |per_m: f64| per_m * camera.focal_length_m / 1e3;
        let left = transfer.at(frequency);
        let found = match frequency {
            _ if frequency > transfer.nyquist_per_m() => Err(Unknown::FinerThanPixels),
            _ if frequency >= transfer.cutoff_per_m() => Err(Unknown::FinerThanLens),
            _ => Ok(vec![mrtd_k(PERCEPTION, netd, left)]),
        };
        row.under("frequency_cycles_per_mrad", per_mrad(frequency))
            .under("finest_cycles_per_mrad", per_mrad(transfer.nyquist_per_m()))
            .under("transfer", left)
            .with(found)
    }

    fn material(&self) -> CompanionRow {
        self.bound(Measure::Material, Ok(1.0))
    }

    /// Of all pixels that the target covers: d √A with A areas of a pixel, since a pixel of which it fills the share φ adds no more
    /// than φ d² to d²: its signal is φ of that of a full one, its other noise no less than φ of it.
    fn material_of_all_pixels(&self) -> CompanionRow {
        if let Some((told, pixels)) = self.given.told.and_then(|told| Some((told, told.pixels?))) {
            let distance = told.statistical_distance;
            return CompanionRow::new(Measure::MaterialOfAllPixels, None)
                .under("pixels", pixels)
                .of("target", told.target)
                .of("alternative", told.alternative)
                .with(Ok(vec![distance, detection::probability(distance)]));
        }
        // Within one pixel that share is in d already.
        self.bound(Measure::MaterialOfAllPixels, self.across.map(|pixels| pixels.max(1.0)))
    }

    fn bound(&self, measure: Measure, across: Known<f64>) -> CompanionRow {
        let mut row = CompanionRow::new(measure, None);
        if let Ok(across) = across {
            row = row.under("pixels", across * across);
        }
        let Some(camera) = self.given.camera else { return row.with(Err(Unknown::NoCamera)) };
        row = row.under("bands", self.given.bands.len() as f64).under("frames", f64::from(camera.frames));
        let Some(told) = self.given.told else { return row.with(Err(Unknown::NotCompared)) };
        let distances = across.map(|across| {
            let distance = told.statistical_distance * across;
            vec![distance, detection::probability(distance)]
        });
        row.of("target", told.target).of("alternative", told.alternative).with(distances)
    }
}

fn pixels_and_cycles(pixels: f64) -> Vec<f64> {
    vec![pixels, pixels / PIXELS_PER_CYCLE]
}
