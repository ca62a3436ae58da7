//! Writes `[scene]` and `[[object]]`.

use super::super::entries::{Document, Entries};
use super::super::paths::Paths;
use super::{Form, ObjectSpec, SceneSpec, SkySpec, SurfaceSpec};
use hadar::units::Dimension;

pub(crate) fn scene(spec: &SceneSpec, paths: Paths<'_>) -> Entries {
    let material = |material: &Option<_>| material.as_ref().map(|material| paths.material(material));
    let ground = spec.ground.as_ref().map(|ground| {
        surface(Entries::default(), &ground.surface, paths)
            .put_if("marks", ground.marks.as_ref().map(|marks| paths.material(marks)))
            .table()
    });
    let sky = spec.sky.as_ref().map(|sky| match sky {
        SkySpec::Spectrum { path, column } => {
            Entries::default().put("spectrum", paths.file(path)).put("column", column.clone()).table()
        }
        SkySpec::Surface { material, temperature_k } => Entries::default()
            .put_if("material", material.as_ref().map(|material| paths.material(material)))
            .put_quantity("temperature", Dimension::Temperature, Some(*temperature_k))
            .table(),
    });
    Entries::default()
        .put_quantity("ground_temperature", Dimension::Temperature, spec.ground_temperature_k)
        .put_quantity("sky_temperature", Dimension::Temperature, spec.sky_temperature_k)
        .put_quantity("car_temperature", Dimension::Temperature, spec.car_temperature_k)
        .put_quantity("person_temperature", Dimension::Temperature, spec.person_temperature_k)
        .put_if("ground_emissivity", spec.ground_emissivity.map(|ends| ends.to_vec()))
        .put_if("car", material(&spec.car))
        .put_if("person", material(&spec.person))
        .put_quantity("car_distance", Dimension::Length, spec.car_distance_m)
        .put_quantity("person_distance", Dimension::Length, spec.person_distance_m)
        .put_if("sky", sky)
        .put_if("ground", ground)
        .put_if(
            "library",
            spec.library.as_ref().map(|all| all.iter().map(|m| paths.material(m)).collect::<Vec<_>>()),
        )
        .put_quantity("camera_height", Dimension::Length, spec.camera_height_m)
        .put_quantity("camera_pitch", Dimension::Angle, spec.camera_pitch_rad)
        .put_if("bounces", spec.bounces)
        .put_if("size", spec.size.map(|size| size.map(|n| i64::try_from(n).unwrap_or(i64::MAX)).to_vec()))
}

/// `[scene]`, and `[[object]]` where there are any.
pub(crate) fn document(spec: &SceneSpec, paths: Paths<'_>) -> Document {
    let objects = |objects: &Vec<ObjectSpec>| -> Vec<Entries> {
        objects.iter().map(|spec| object(spec, paths)).collect()
    };
    Document::default().put("scene", scene(spec, paths)).put_if("object", spec.objects.as_ref().map(objects))
}

fn object(spec: &ObjectSpec, paths: Paths<'_>) -> Entries {
    let all = |size: &[f64]| size.iter().map(|length| Dimension::Length.format(*length)).collect::<Vec<_>>();
    let entries = Entries::default().put_if("name", spec.name.clone()).put("shape", spec.form.name());
    let entries =
        match &spec.form {
            Form::Person(height_m) | Form::Robot(height_m) => {
                entries.put_quantity("height", Dimension::Length, *height_m)
            }
            Form::Car(size, tyres) => {
                let entries = match size {
                    Some(size) => entries.put_written("size", Dimension::Length, all(size)),
                    None => entries,
                };
                entries.put_if(
                    "tyres",
                    tyres.as_ref().map(|tyres| surface(Entries::default(), tyres, paths).table()),
                )
            }
            Form::Block(size) => entries.put_written("size", Dimension::Length, all(size)),
            Form::Post([height_m, radius_m]) => entries
                .put_quantity("height", Dimension::Length, Some(*height_m))
                .put_quantity("radius", Dimension::Length, Some(*radius_m)),
            Form::Ball(size, above_m) => entries
                .put_written("size", Dimension::Length, all(size))
                .put_quantity("above", Dimension::Length, Some(*above_m)),
        };
    surface(entries.put_written("at", Dimension::Length, all(&spec.at_m)), &spec.surface, paths)
}

fn surface(entries: Entries, spec: &SurfaceSpec, paths: Paths<'_>) -> Entries {
    let some = |value: f64| (value > 0.0).then_some(value);
    entries
        .put("material", paths.material(&spec.material))
        .put_quantity("temperature", Dimension::Temperature, Some(spec.temperature_k))
        .put_quantity("variation", Dimension::TemperatureDifference, some(spec.variation_k))
        .put_quantity("variation_size", Dimension::Length, spec.variation_size_m)
        .put_if("roughness", some(spec.roughness))
        .put_quantity("roughness_size", Dimension::Length, spec.roughness_size_m)
}
