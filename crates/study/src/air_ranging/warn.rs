//! What the reader of a distance by air must know.

use super::AirRangingStudy;
use super::results::AirRanging;
use crate::Warning;
use hadar::error::Result;
use hadar::fisher::precision::Sight;
use hadar_scenario::{AtmosphereSource, MaterialRef};

/// Width of the bands that the embedded tables are means over, cm⁻¹.
const TABLE_CM1: f64 = 20.0;
/// Relative rounding error that three printed digits stand for.
const PRINTED: f64 = 1e-3;

impl AirRangingStudy {
    pub(super) fn warnings(&self, result: &AirRanging) -> Result<Vec<Warning>> {
        let mut warnings = self.study.warnings.clone();
        let (scene, camera, at_m) = (&self.scenario.scene, &self.camera, result.at.distance_m);
        match result.sight.status {
            Sight::Seen => {}
            Sight::Unchanged => warnings.push(Warning::DistanceUnchanged { distance_m: at_m }),
            Sight::Imitated => warnings.push(Warning::DistanceImitated { distance_m: at_m }),
        }
        if result.sight.relative_error > PRINTED {
            let relative_error = result.sight.relative_error;
            warnings.push(Warning::FewDigits { distance: "least error of the distance", relative_error });
        }
        if !result.sight.without_effect.is_empty() && result.sight.status == Sight::Seen {
            warnings.push(Warning::AirUnknownWithoutEffect { unknowns: result.sight.without_effect.clone() });
        }
        if self.scenario.unknown.emissivity.is_none() {
            warnings.push(Warning::EmissivityTakenAsExact);
        }
        let embedded =
            matches!(scene.atmosphere.as_ref().map(|spec| &spec.source), Some(AtmosphereSource::Model(_)));
        let widths = self.study.open_bands.widths_cm1();
        let narrowest_cm1 = widths.iter().copied().fold(f64::INFINITY, f64::min);
        if embedded && narrowest_cm1 < TABLE_CM1 {
            warnings.push(Warning::AirBandMeans { narrowest_cm1, table_cm1: TABLE_CM1 });
        }
        let shortest_m = self.scene()?.air.shortest_m();
        let nearest_m = result.curve.iter().map(|point| point.distance_m).fold(at_m, f64::min);
        if nearest_m < shortest_m {
            warnings.push(Warning::AirExtrapolated { nearest_m, shortest_m });
        }
        let is_sky = |material: &Option<MaterialRef>| matches!(material, Some(MaterialRef::Name(name)) if name.starts_with("sky"));
        if scene.environment.iter().any(|object| is_sky(&object.material)) {
            warnings.push(Warning::AirMirroredSky);
        }
        if let Some(full_well) = camera.full_well {
            let counts = self.brightest(at_m)?;
            if counts > full_well {
                warnings.push(Warning::FullWell { counts, full_well });
            }
        }
        let of_scene = [
            self.study.size_unknown(camera, Some(at_m)),
            self.study.outside_range(camera),
            crate::warn::assumed(camera),
        ];
        warnings.extend(of_scene.into_iter().flatten());
        warnings.extend(self.study.camera_warnings());
        Ok(warnings)
    }
}
