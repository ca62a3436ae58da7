//! The report's text.

use super::row::{CAMERAS, Row};
use crate::reproduce::studies::page::markdown;
use hadar::words::{share, significant};
use hadar_report::words::Say;
use hadar_study::ClassAnswer;

fn photons(row: &Row) -> String {
    row.photons.map_or_else(|| "no number".into(), |photons| significant(photons, 3))
}

/// What came out, in a few sentences.
pub(super) fn finding(rows: &[Row]) -> String {
    let each = rows.iter().map(|row| {
        let members = row.classes.first().map_or_else(String::new, |answer| format!(" ({})", answer.say()));
        format!("{}: {} photons{members}", row.what, photons(row))
    });
    each.collect::<Vec<_>>().join("\n")
}

/// README.md.
pub(super) fn readme(rows: &[Row]) -> String {
    let table: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            let spectra = row.classes.first().map_or_else(
                || "1 x 1".to_owned(),
                |answer| format!("{} x {}", answer.target.spectra, answer.alternative.spectra),
            );
            let told = row.classes.last().and_then(|answer| answer.share_of_pairs_told);
            vec![
                row.what.clone(),
                spectra,
                significant(row.distance, 3),
                significant(row.lower, 3),
                photons(row),
                significant(row.reached[0], 3),
                significant(row.reached[1], 3),
                told.map_or_else(String::new, share),
            ]
        })
        .collect();
    let header = [
        "question",
        "spectra",
        "nearest distance, worst pair",
        "proved: at least",
        "photons for d = 1",
        "d, flir-a325sc",
        "d, ideal-pnrd",
        "pairs told, ideal-pnrd",
    ];
    let mut left = Vec::new();
    for (row, answer) in rows.iter().filter_map(|row| Some((row, row.classes.first()?))) {
        for without in &answer.leave_one_out {
            let d = without.distance.map_or_else(|| "nothing left".into(), |d| significant(d, 3));
            left.push(vec![row.what.clone(), answer.worst.join(" against "), without.member.clone(), d]);
        }
    }
    let of = |what: &str| rows.iter().find(|row| row.what == what);
    let (today, painted) = (rows.first(), of("person against painted-robot"));
    let (metal, mixed) = (of("person against metal-robot"), of("person against painted-robot, mixed"));
    let compared = match (today, painted, metal, mixed) {
        (Some(today), Some(painted), Some(metal), Some(mixed)) => format!(
            "Two curves, skin entered as 0.95 in all bands and the robot of the paper, ask for {} photons in these bands. Measured spectra of a \
             person ask for {} before painted robots, for {} before metal ones, and for {} before robots painted in several colours within a pixel. \
             The distance that {} reaches is {} for the two curves and {} in the worst of all cases; that of {} is {} and {}.",
            photons(today),
            photons(painted),
            photons(metal),
            photons(mixed),
            CAMERAS[0],
            significant(today.reached[0], 3),
            significant(mixed.reached[0], 2),
            CAMERAS[1],
            significant(today.reached[1], 3),
            significant(mixed.reached[1], 3),
        ),
        _ => String::new(),
    };
    let mixtures = mixed.and_then(|row| row.classes.first()?.mixtures.as_ref()).map_or_else(String::new, |found| {
        let parts = found.alternative.iter().map(|(name, part)| format!("{} {name}", share(*part)));
        format!(
            "\n\nThe worst of the mixtures found is {} per sqrt(photon) away: {}. No mixture is nearer than {}, even with every part in a lighting of its \
             own.",
            significant(found.distance, 3),
            parts.collect::<Vec<_>>().join(", "),
            significant(found.distance_lower, 3)
        )
    });
    let chance = painted.and_then(|row| row.classes.first()).map_or_else(String::new, |answer| {
        let of = |side| ClassAnswer::chance_one_more_is_nearer(side).map_or(0.0, |chance| 1.0 / chance);
        format!(
            "One more spectrum of a person is harder than all of these with a chance of at most 1 in {:.0}, one more of a paint of at most 1 in {:.0}, if \
             they are drawn alike: the class of persons rests on too few spectra to be any person.",
            of(&answer.target),
            of(&answer.alternative)
        )
    });
    format!(
        "# Person or robot, with classes on both sides\n\n\
         Made by `hadar reproduce person-or-robot --library ECOSTRESS --library TABLE`: the folder of the ECOSTRESS spectral library \
         (Baldridge et al. 2009, Meerdink et al. 2019; its paints, metals and plates) and the table `emiLib_synthetic` that the authors of the paper publish \
         (github.com/FanglinBao/HADAR, MIT). Moist tissue is the built-in `tissue-blood-proxy`. The spectra themselves are not part of this program.\n\n\
         {compared} The verdicts stay: no for the one, yes for the other, and now for every pair of spectra.{mixtures}\n\n\
         ![Photons required](distances.png)\n\n{}\n\
         The distances are per sqrt(photon) in 44 bands of 10 cm^-1 from 810 to 1240 cm^-1, which all spectra cover; 37 degC, V = 0.5, surroundings of 20 degC; \
         the robot's temperature and lighting are unknown.\n\n\
         ## Which spectra decide\n\n\
         ![Every person against every paint](painted_robot.png)\n\n![Every person against every metal](metal_robot.png)\n\n{}\n\
         {chance}\n",
        markdown(&header, &table),
        markdown(&["question", "hardest pair", "without", "distance that is left"], &left),
    )
}
