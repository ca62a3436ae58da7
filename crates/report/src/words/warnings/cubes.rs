//! Cubes and what is estimated from them: emissivities, materials, objects.

use super::block::{short, words};
use crate::words::decompose::judged::cause;
use hadar::words::{share, significant};

words! {
    AxesInDoubt {
        meaning: "The first axis of a cube is so short that it may be that of the bands.",
        remedy: "Write cube.axes, \"bands,rows,columns\" or \"rows,columns,bands\".",
        AxesInDoubt { rows, columns, bands } => format!(
            "the cube was read as {rows} rows x {columns} columns x {bands} bands, though its first axis is the shortest by far"
        ),
    }
    UnitConverted {
        meaning: "The file of a cube states another unit of spectral radiance than the scenario: its samples are taken in the file's, band by band at the \
            centre, and the noise in the scenario's.",
        remedy: "If the file is wrong, correct it; else nothing need be done.",
        UnitConverted { file, scenario, of_mean } => format!(
            "the samples are in `{file}` by their file: they were taken so, each band at its centre (at most {} off the mean over a band), and the noise in `{scenario}`, as the scenario says",
            share(*of_mean)
        ),
    }
    BandOrderTaken {
        meaning: "The file of a cube does not say in which order it has its bands, and [bands] do not begin with the smallest wavenumber. A list (rows, filters, \
            ranges) was taken to be in the order of the file; with a grid the file's bands were taken in rising wavenumber.",
        remedy: "Write the cube with its wavelengths, as an ENVI file, or put the list, or the bands, into that order.",
        BandOrderTaken { listed: true } => "the cube's file does not say where its bands are: they were taken in the order in which [bands] list them",
        BandOrderTaken { .. } => "the bands are written as wavelengths, but the cube's file does not say them: its first band was taken as that of the \
             longest wavelength",
    }
    WavelengthsUnused {
        meaning: "The file of a cube lists wavelengths or wavenumbers without a unit, or on an axis that is not read (not linear, in air), which are not used.",
        remedy: "Write the unit into the file, as `wavelength units = Micrometers` in an ENVI header; in \
            NPZ and MATLAB call the list `wavelengths_um`. Of an axis that is not linear give the bands as rows.",
        WavelengthsUnused => "the cube's file lists its wavelengths or wavenumbers without a unit, or on an axis that is not read, so that they were not used: its \
             bands were taken in the order of [bands], of a grid in rising wavenumber",
    }
    CubeDark {
        meaning: "Pixels of a cube are 0 in all bands: nothing was measured there.",
        remedy: "Check the file and what was read of it; write NaN where nothing was measured.",
        CubeDark { view, pixels, of } if pixels == of => {
            format!("all samples of the {view} view are 0: it is empty")
        },
        CubeDark { view, pixels, of } => {
            format!("{pixels} of {of} pixels of the {view} view that were looked at are 0 in all bands")
        },
    }
    CubeSaturated {
        meaning: "Many pixels of a cube have a sample at one and the same value, the largest of all: \
            readings that were cut off there.",
        remedy: "Shorten the exposure, or write NaN where readings are cut off.",
        CubeSaturated { view, pixels, of, value, largest } => format!(
            "{pixels} of {of} pixels of the {view} view that were looked at have a sample at {}, the largest value of all{}: where \
             readings are clipped, texture is lost and false edges appear",
            short(*value),
            if *largest { " and of the file's type" } else { "" }
        ),
    }
    WindowsMissing {
        meaning: "Windows with a missing sample have no bound, and NaN in the maps.",
        remedy: "Nothing; or fill missing samples, or make the window smaller.",
        WindowsMissing { windows, of } => format!(
            "{windows} of {of} windows hold a sample that is missing: they have no bound, and NaN in the maps"
        ),
    }
    PixelsSkipped {
        meaning: "Pixels of a cube were left out since a sample of them is missing.",
        remedy: "Nothing; or name bands that are always missing in cube.bad_bands.",
        PixelsSkipped { pixels, of } => {
            format!("{pixels} of {of} pixels have a sample that is no number; they were left out")
        },
    }
    RowsUneven {
        meaning: "Rows of a cube represent surroundings, and some of their pixels are unlike the others: they are not included in the mean.",
        remedy: "Nothing; or name rows that show one and the same thing.",
        RowsUneven { environment, pixels, of } => format!(
            "{pixels} of {of} pixels of the rows of environment[{environment}] are not like the others; they were left out of the mean"
        ),
    }
    BandsFoundBad {
        meaning: "Bands have no readings: absent from the cube's file, missing in most pixels, one and the same value in all of them, or, of a \
            blackbody, cut off.",
        remedy: "Nothing, or name them in bad_bands; write cube.bad = \"keep\" in a decomposition to take them like all others.",
        BandsFoundBad { bands, why } => {
            let named: Vec<String> = bands.iter().take(12).map(usize::to_string).collect();
            let more = if bands.len() > 12 { format!(" and {} more", bands.len() - 12) } else { String::new() };
            let named = named.join(", ");
            match *why {
                "absent" => format!("bands {named}{more} of [bands] (from 0, in rising wavenumber) are not in the cube's file: they were left out"),
                _ => format!("bands {named}{more} (from 0, in rising wavenumber) are {why}: they were left out"),
            }
        },
    }
    FiltersLeftOut {
        meaning: "Filters of a calibration have no readings in the cube of some blackbody: missing in most pixels, one value in all of them, or cut off.",
        remedy: "Nothing, or name their bands in bad_bands of [[blackbody]]; expose for a shorter time where they are saturated.",
        FiltersLeftOut { filters, why } => format!("filters {} are {why} before a blackbody: they were left out", filters.join(", ")),
    }
    PixelsFoundBad {
        meaning: "Pixels of a cube are dead, stuck at one value, cut off, brighter than the temperature range allows, or far outside the values around them.",
        remedy: "Nothing; write cube.bad = \"keep\" to take them like all others; widen unknown.temperature if the scene has hotter objects.",
        PixelsFoundBad { pixels, of, why } => format!("{pixels} of {of} pixels are {why}: they were left out (bad_pixels.npy)"),
        ViewFoundBad { view, pixels, of, why: "outlier" } => format!(
            "{pixels} of {of} pixels of the {view} view are outliers, far from all values around them (hot pixels, or objects of a pixel or two): their \
             samples count as missing (bad_pixels_{view}.npy); cube.bad = \"keep\" takes them as they are"
        ),
        ViewFoundBad { view, pixels, of, why } => format!(
            "{pixels} of {of} pixels of the {view} view are {why}: their samples count as missing (bad_pixels_{view}.npy); \
             cube.bad = \"keep\" takes them as they are"
        ),
    }
    LibraryDoesNotFit {
        meaning: "Pixels of a cube are explained by no material of the library.",
        remedy: "Add materials, state how wrong the library is with library.emissivity_error, or check the \
            unit and the light.",
        LibraryDoesNotFit { pixels, of } => {
            format!("{pixels} of {of} pixels are explained by no material of the library (p below 1e-4)")
        },
    }
    ModelRejected {
        meaning: "The pixels of a cube together do not follow the model they are decomposed with, though each may \
            fit by itself: what is said of them holds only if the model does.",
        remedy: "Look at the causes under `model`: correct the gain, the bands or the light that is named; leave a bad \
            band out with cube.bad_bands; add what is missing to the library or the surroundings.",
        ModelRejected { if_it_holds, causes } => {
            let most = causes.first().map_or_else(
                || "no single cause that is known explains it".to_owned(),
                |row| format!("most of it would be explained by {}", cause(row)),
            );
            format!("the cube does not follow its model: {if_it_holds} pixels would be decided if it held; {most}")
        },
    }
    LibraryTakenAsExact {
        meaning: "The emissivities of the library are taken as exact: intervals do not include \
            their errors.",
        remedy: "State library.emissivity_error if the spectra are measured.",
        LibraryTakenAsExact => "the library is taken as exact: errors of its emissivities make temperatures less accurate than stated",
    }
    LibraryErrorNotSmall {
        meaning: "The errors of the library's emissivities are not small compared with what a material reflects. Deviations hold them to first \
            order: the fit's own derivatives have the same error, and intervals hold the truth less often than they state.",
        remedy: "State a smaller emissivity_error if the spectra are better; else take temperatures of such a material as known to several \
            of their deviations.",
        LibraryErrorNotSmall { share } => format!(
            "the errors of the emissivities are up to {} % of what a material reflects: temperatures err by more than their deviations, which \
             hold such errors to first order (at 5 % some 5 % too few are held, at 20 % half)",
            significant(100.0 * share, 2)
        ),
    }
    NoRelativeEmissivity {
        meaning: "Pixels of a cube radiate like what lights them, or like no possible surface: no emissivity \
            follows from one of them alone.",
        remedy: "Nothing if they are few; else check unit and surroundings, or look when the scene is \
            warmer than its sky.",
        NoRelativeEmissivity { pixels, of } => format!(
            "{pixels} of {of} pixels that were looked at have no emissivity by themselves: they radiate like what lights them, or \
             like no possible surface"
        ),
    }
    OneCluster {
        meaning: "One emissivity is used for all pixels, whatever they are.",
        remedy: "Write clusters.count = [1, 8], unless the cube shows one material.",
        OneCluster => "one emissivity is used for all pixels, whatever they are made of",
    }
    ClustersWithoutPixels {
        meaning: "Clusters were left without a pixel: the others explain all of them better.",
        remedy: "Ask for fewer, or for a range of counts.",
        ClustersWithoutPixels { left, asked } => {
            format!("of {asked} clusters {left} have pixels; the others were left out")
        },
    }
    MagnitudeHardlyTold {
        meaning: "The magnitude of an emissivity is hardly distinguished from the temperatures of its pixels: the \
            prior determines it.",
        remedy: "State unknown.lighting_total, fewer surroundings, or [emissivity] as well as you know it; \
            look under a sky with lines, at pixels of different lighting.",
        MagnitudeHardlyTold { clusters, sigma } => format!(
            "the magnitude of {} is hardly distinguished from the temperatures (mean emissivity +- {} at most): the prior of the \
             emissivities determines it",
            clusters.join(", "),
            significant(*sigma, 2)
        ),
    }
    ClusterDoesNotFit {
        meaning: "The pixels of a cluster scatter about one emissivity by more than their noise: several \
            materials, or a group that was not found.",
        remedy: "Ask for more clusters or a range of counts; check unit, noise and light; do not use the \
            emissivities of these.",
        ClusterDoesNotFit { clusters, chi_square } => format!(
            "the pixels of {} are not explained by one emissivity each (chi2/nu up to {}): they are several materials or none that was \
             found, and their errors do not hold",
            clusters.join(", "),
            significant(*chi_square, 3)
        ),
    }
    MirrorNotExcluded {
        meaning: "Several surroundings light a pixel and their total is not stated: a mirror of them is \
            not distinguished from an equally warm surface.",
        remedy: "State unknown.lighting_total, or name fewer surroundings.",
        MirrorNotExcluded { surroundings } => format!(
            "{surroundings} surroundings light a pixel, their total not stated: a mirror of them fits as well as a warm surface, so that \
             emissivities and temperatures may be entirely wrong, by far more than their errors"
        ),
    }
    ClustersNotSettled {
        meaning: "The last round of grouping and fitting still changed something.",
        remedy: "Compare with another --seed; ask for fewer clusters.",
        ClustersNotSettled { rounds } => {
            format!("after {rounds} rounds clusters and emissivities still changed")
        },
    }
    ObjectsUndecided {
        meaning: "Objects rest on pixels that are not decided by themselves: their neighbours settle their category, or nothing does.",
        remedy: "Do not act on them: look closer, expose longer, or add what is there to the library.",
        ObjectsUndecided { objects, of } => format!(
            "in {objects} of {of} objects less than half of the pixels are decided by themselves: what they are rests on what is around them, \
             or is left open"
        ),
    }
    SpatialPrior {
        meaning: "Materials, posteriors and temperatures rest on a prior over the image: small objects that \
            hardly differ from their surroundings are lost.",
        remedy: "Compare with the answer without [spatial]; trust an object of few pixels only if it is in \
            both.",
        SpatialPrior { changed, pixels, settled } => {
            let but = if *settled { "" } else { "; its last sweep still changed something" };
            format!(
                "materials, candidates and temperatures rest on a prior over the image, which changed the material of {changed} \
                 of {pixels} pixels{but}"
            )
        },
    }
}
