//! The categories of a scenario as places in its library.

use hadar::error::Error;
use hadar_estimate::segmentation::{Categories, Part};
use hadar_scenario::decompose::CategorySpec;

/// The parts of all categories as places in the library, a class as all its members; an error with its key.
pub(super) fn parts(
    specs: &[CategorySpec],
    names: &[String],
    classes: &[(String, Vec<usize>)],
) -> std::result::Result<Categories, (String, Error)> {
    let mut all = Vec::with_capacity(specs.len());
    for (i, spec) in specs.iter().enumerate() {
        let mut parts: Vec<Part> = Vec::new();
        for (j, name) in spec.materials.iter().enumerate() {
            let key = format!("category[{i}].materials[{j}]");
            let class = classes.iter().find(|(class, _)| class == name).map(|(_, members)| members.clone());
            let places = class.or_else(|| names.iter().position(|one| one == name).map(|place| vec![place]));
            let Some(places) = places else {
                let known = names.iter().chain(classes.iter().map(|(class, _)| class));
                let known: Vec<&str> = known.map(String::as_str).collect();
                return Err((key, Error::unknown_name("material of the library", name, known)));
            };
            let enclosed = spec.enclosed.contains(name);
            for material in places {
                if parts.iter().any(|part| part.material == material) {
                    let found = format!("`{}` stands in the category twice", names[material]);
                    return Err((key, Error::malformed(found, "name it once, by itself or by its class")));
                }
                parts.push(Part { material, enclosed });
            }
        }
        all.push(parts);
    }
    Categories::new(names.len(), &all).map_err(|error| ("category".to_owned(), error))
}
