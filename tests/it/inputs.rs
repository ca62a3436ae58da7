//! What is built in is noted when it is used, with what it consists of.

use hadar::atmosphere::Atmosphere;
use hadar::inputs::{self, Inputs, Noting};
use hadar::instrument::presets;
use hadar::material::Library;

#[test]
fn what_is_used_is_noted_with_what_it_is_made_of() {
    let noting = Noting::open();
    let library = Library::embedded().unwrap();
    assert_eq!(noting.so_far(), Inputs::default());
    library.get("brass-rough").unwrap();
    presets::get("ideal-pnrd").unwrap();
    Atmosphere::embedded("tropical").unwrap();
    let found = noting.so_far();
    let names: Vec<_> = found.built_in.keys().map(|(kind, name)| format!("{kind} {name}")).collect();
    assert_eq!(names, ["air tropical", "camera ideal-pnrd", "material brass-rough"]);
    // Its own entry, that of the brass it is made of, and the constants of that, not those of others.
    let content = &found.built_in[&("material", "brass-rough".to_owned())];
    let content = String::from_utf8(content.to_vec()).unwrap();
    assert!(content.contains("name = \"brass-rough\"") && content.contains("name = \"brass\""), "{content}");
    assert!(content.contains("n,k") || content.lines().count() > 50, "{content}");
    assert!(!content.contains("name = \"iron\""));
    drop(noting);
    library.get("gold").unwrap();
    assert_eq!(inputs::so_far(), Inputs::default());
}
