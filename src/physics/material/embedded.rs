//! The text of `spectra/`, compiled into the library so that it needs no files at run time.

/// The manifest.
pub(super) const MANIFEST: &str = include_str!("../../../spectra/manifest.toml");

/// The text of each file in the list, with its path in `spectra/`.
macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../../../spectra/", $path)))),*]
    };
}

/// Every file that the manifest names.
pub(super) const FILES: &[(&str, &str)] = files![
    "nk/aluminium-oxide.csv",
    "nk/bk7-glass.csv",
    "nk/blood.csv",
    "nk/brass.csv",
    "nk/calcium-sulphate-alpha.csv",
    "nk/calcium-sulphate-beta.csv",
    "nk/calcium-sulphate-gamma.csv",
    "nk/copper.csv",
    "nk/dolomite-extraordinary.csv",
    "nk/dolomite-ordinary.csv",
    "nk/gold.csv",
    "nk/graphite.csv",
    "nk/hematite-extraordinary.csv",
    "nk/hematite-ordinary.csv",
    "nk/ice.csv",
    "nk/illite.csv",
    "nk/iron.csv",
    "nk/kaolinite.csv",
    "nk/magnesium-oxide.csv",
    "nk/montmorillonite.csv",
    "nk/nickel.csv",
    "nk/pdms.csv",
    "nk/pei.csv",
    "nk/pet.csv",
    "nk/polycarbonate.csv",
    "nk/polystyrene.csv",
    "nk/pvc.csv",
    "nk/silicon-nitride.csv",
    "nk/silicon.csv",
    "nk/silver.csv",
    "nk/soda-lime-glass.csv",
    "nk/titanium-dioxide.csv",
    "nk/titanium.csv",
    "nk/tungsten.csv",
    "nk/water.csv",
    "nk/zinc-oxide.csv",
    "nk/zinc.csv",
    "sky/midlatitude-summer.csv",
    "sky/midlatitude-winter.csv",
    "sky/subarctic-summer.csv",
    "sky/tropical.csv",
    "sky/us-standard.csv",
];
