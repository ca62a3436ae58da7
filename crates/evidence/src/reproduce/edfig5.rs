//! Ext. Data Fig. 5: pictures of one heat cube, their standard deviation in 3 × 3 pixels, and what they tell of places.
//!
//! The paper's measure of texture, the standard deviation of the shown image (SII D; also Figs. S13, S14, S33), beside the Fisher
//! information of a window's position (S37), which bounds what ranging makes of it. Images: the thermal image; the same equalised (CLAHE)
//! and shown in 256 levels; pseudo-TeX vision (SIII D), which is made of the thermal image alone; texture X of the decomposed cube and its
//! distilled form; the cube itself.
//!
//! * Information of an equalised image: a pointwise rising map steepens image and noise alike, so that all of J stays; 256 levels take
//!   a share away ([`hadar::ranging::levels`]).
//! * Information of a texture: S37 with the deviation that the fit gives it ([`hadar_estimate::decompose::texture_information`]).

mod compared;

use self::compared::{Compared, HALF, Row, SIDE, compared, scaled, shown};
use super::ledger::{Line, Verdict};
use super::order::{Figures, Made, Order};
use super::textured::window_sums;
use hadar::error::Result;
use hadar::words::significant;
use hadar_estimate::separation::k_means;
use hadar_report::bundle::Bundle;
use hadar_report::decompose::{DARKEST, Vision, brightness, saturation};
use hadar_report::figures::Plot;
use hadar_report::plot::{Axis, Painted, Picture};
use hadar_report::range::picture_plot;
use hadar_report::table::{Table, markdown, number};
use hadar_study::decompose::hues_deg;
use hadar_study::range::quantile;

/// Segments of the thermal image in pseudo-TeX vision.
const SEGMENTS: usize = 6;
/// The paper's mean standard deviations: TeX vision, and the enhanced thermal image.
const PAPER: [f64; 2] = [0.0788, 0.0170];

pub(super) fn make(order: Order) -> Result<Made> {
    let found = compared(order)?;
    let mut bundle = Bundle::default();
    bundle.add_asked("scenario.toml", found.yard.scenario.to_toml());
    bundle.add_table("textures.csv", table(&found.rows))?;
    let plots: Vec<Plot> = [looks(&found, order)?, maps(&found)].into_iter().flatten().collect();
    bundle.add_plots(&plots)?;
    let pictures = vec![
        ("looks.png", "One heat cube as a thermal image, equalised, as pseudo-TeX and as TeX vision"),
        ("information.png", "What each measure says of the position of a window"),
    ];
    Ok((bundle, lines(&found), Figures { pictures, text: text(&found) }))
}

fn table(rows: &[Row]) -> Table {
    let mut table = Table::new([
        "image",
        "standard_deviation",
        "standard_deviation_noise_free",
        "information_ground_per_px2",
        "information_ground_over_cube",
        "information_all_per_px2",
        "information_by_matching_ground_per_px2",
    ]);
    let cube = rows.first().map_or(f64::NAN, |row| row.information);
    let maybe = |x: Option<f64>| x.map_or_else(String::new, number);
    for row in rows {
        table.push(vec![
            row.name.to_owned(),
            maybe(row.deviation),
            maybe(row.deviation_noise_free),
            number(row.information),
            number(row.information / cube),
            number(row.information_all),
            maybe(row.by_matching),
        ]);
    }
    table
}

/// The pictures in one look.
fn looks(found: &Compared, order: Order) -> Result<Option<Plot>> {
    let (yard, columns) = (&found.yard, found.yard.shape.columns());
    let groups = k_means(&found.thermal, 1, SEGMENTS, order.seed, 4)?;
    let mut sorted: Vec<usize> = (0..SEGMENTS).collect();
    sorted.sort_by(|a, b| groups.centres[*a].total_cmp(&groups.centres[*b]));
    let segments: Vec<String> = (0..SEGMENTS).map(|i| format!("segment {i}")).collect();
    let of_segment = hues_deg(&segments, |_| None);
    let of_material = hues_deg(&yard.expected.materials, |_| None);
    let rank = |group: usize| sorted.iter().position(|own| *own == group).unwrap_or(0);
    let warm = scaled(&found.thermal);
    let pseudo = Vision {
        hue_deg: groups.group.iter().map(|group| of_segment.get(rank(*group)).copied()).collect(),
        saturation: warm.iter().map(|x| saturation(*x, [0.0, 1.0])).collect(),
        brightness: found.equalised.iter().map(|x| DARKEST + (1.0 - DARKEST) * x).collect(),
    };
    let mut known: Vec<f64> =
        found.maps.temperature_k.iter().map(|t| f64::from(*t)).filter(|t| t.is_finite()).collect();
    known.sort_by(f64::total_cmp);
    let at = |share: f64| known.get((share * known.len() as f64) as usize).copied().unwrap_or(290.0);
    let ends = [at(0.1), at(0.9).max(at(0.1) + 1.0)];
    let hues: Vec<Option<f64>> =
        found.maps.material.iter().map(|m| of_material.get(usize::from(*m)).copied()).collect();
    let tex = |texture: &[f32]| Vision {
        saturation: hues
            .iter()
            .zip(&found.maps.temperature_k)
            .map(|(hue, t)| hue.map_or(0.0, |_| saturation(f64::from(*t), ends)))
            .collect(),
        brightness: brightness(texture, columns),
        hue_deg: hues.clone(),
    };
    // Hue alone names no material to all eyes.
    let truth = yard.expected.views.first().map(|view| view.material.as_slice()).unwrap_or_default();
    let materials: Vec<Option<usize>> =
        truth.iter().map(|m| Some(usize::from(*m)).filter(|_| *m != u16::MAX)).collect();
    let painted = |key: &str, title: &str, vision: &Vision| {
        let mut picture = Picture::painted(
            title,
            Axis::linear("").range(0.0, 1.0),
            columns,
            Painted { pixels: vision.pixels(), ramp: None },
        );
        picture.values.clone_from(&vision.brightness);
        if key != "pseudo_tex_brightness" {
            picture = picture.name_areas(&materials, &yard.expected.materials);
        }
        (key.to_owned(), picture)
    };
    let pictures = vec![
        (
            "thermal_counts".to_owned(),
            Picture::new("Thermal image, all bands", Axis::linear("counts"), columns, found.thermal.clone()),
        ),
        (
            "equalised".to_owned(),
            Picture::new(
                "Equalised (CLAHE, 256 levels)",
                Axis::linear("brightness").range(0.0, 1.0),
                columns,
                found.equalised.clone(),
            ),
        ),
        painted(
            "pseudo_tex_brightness",
            "Pseudo-TeX: hue a segment, all of it of the thermal image",
            &pseudo,
        ),
        painted("tex_brightness", "TeX vision, brightness the texture X", &tex(&found.texture)),
        painted(
            "distilled_tex_brightness",
            "TeX vision, brightness the distilled texture",
            &tex(&found.distilled),
        ),
        (
            "distilled_log10".to_owned(),
            Picture::new(
                "Distilled texture alone",
                Axis::linear("logarithm, equalised").range(0.0, 1.0),
                columns,
                shown(&found.distilled, columns),
            ),
        ),
    ];
    let subtitle = "Left camera, 200 us, 54 bands. Grey: nothing told. Hues of materials and of segments are not the same.";
    Ok(picture_plot(
        "looks",
        "What does each way of showing one heat cube keep?",
        subtitle.to_owned(),
        pictures,
    ))
}

/// Information of windows.
fn maps(found: &Compared) -> Option<Plot> {
    let (shape, columns) = (found.yard.shape, found.yard.shape.columns());
    let told: Vec<f64> = window_sums(&found.information.cube, shape, HALF);
    let told: Vec<f64> = told.into_iter().filter(|j| j.is_finite()).collect();
    let most = quantile(&told, 0.9);
    let ends = [1e-6 * most, most];
    let of = |key: &str, title: &str, j: &[f64]| {
        let values = window_sums(j, shape, HALF).iter().map(|j| j.clamp(ends[0], ends[1])).collect();
        (
            key.to_owned(),
            Picture::new(
                title,
                Axis::log("Fisher information J (pixel⁻²)").range(ends[0], ends[1]),
                columns,
                values,
            ),
        )
    };
    let pictures = vec![
        of("cube_per_px2", "Heat cube, all bands: the most there is", &found.information.cube),
        of("thermal_per_px2", "Thermal image", &found.information.thermal),
        of("equalised_per_px2", "Thermal image, equalised, 256 levels", &found.equalised_information),
        of("together_per_px2", "Temperature and lighting together", &found.information.together),
        of("texture_per_px2", "Texture X", &found.information.texture),
        of("distilled_per_px2", "Distilled texture", &found.information.distilled),
    ];
    let subtitle = format!(
        "Of windows of {SIDE} × {SIDE} pixels, from the expected counts. Beyond the scale: its ends."
    );
    picture_plot(
        "information",
        "Which image has most information on where a window is along x?",
        subtitle,
        pictures,
    )
}

fn find<'a>(found: &'a Compared, name: &str) -> Option<&'a Row> {
    found.rows.iter().find(|row| row.name.starts_with(name))
}

fn text(found: &Compared) -> String {
    let cube = found.rows.first().map_or(f64::NAN, |row| row.information);
    let mut text = format!(
        "Standard deviation: mean over windows of {SIDE} × {SIDE}, the whole scale being 1, of the noisy image and of the same without noise. \
         Information: S37 of windows of {SIDE} × {SIDE}, median on the ground, over that of the cube; no processing raises it. By matching: S37 as the \
         paper evaluates it, differences of the noisy image over the variance of matched pixels; of an image of noise alone it would be {}, \
         since noise has slopes too.\n\n",
        significant(0.5 * (SIDE * SIDE) as f64, 2)
    );
    let maybe = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), |x| significant(x, 3));
    let cells = |row: &Row| {
        [
            row.name.to_string(),
            maybe(row.deviation),
            maybe(row.deviation_noise_free),
            significant(row.information / cube, 3),
            significant(row.information_all, 3),
            maybe(row.by_matching),
        ]
    };
    let head = [
        "image",
        "standard deviation",
        "without noise",
        "information / cube's",
        "on all surfaces, pixel^-2",
        "by matching, pixel^-2",
    ];
    text.push_str(&markdown(&head, found.rows.iter().map(cells)));
    text.push_str(
        "\nThe cube tells the most. What is computed from it, decomposition included, tells at most as much: temperature and lighting together are \
         all that a decomposition keeps once the material is known, and each of them is less.\n",
    );
    text
}

fn lines(found: &Compared) -> Vec<Line> {
    let deviation = |name: &str| find(found, name).and_then(|row| row.deviation).unwrap_or(f64::NAN);
    let information = |name: &str| find(found, name).map_or(f64::NAN, |row| row.information);
    let agc = "thermal image, equalised, 256";
    let tex = "texture X, logarithm";
    let ratio = deviation(tex) / deviation(agc);
    let raised = deviation(agc) / deviation("thermal image");
    let kept = information(agc) / information("thermal image");
    let times = |x: f64| format!("{} times", significant(x, 2));
    let over = |name: &str| significant(information(name) / information("heat cube"), 2);
    let noise = |name: &str| {
        find(found, name)
            .and_then(|row| Some(row.deviation? / row.deviation_noise_free?))
            .map_or_else(String::new, |x| significant(x, 2))
    };
    vec![
        Line::compared(
            "Ext. Data Fig. 5",
            "mean standard deviation in 3 x 3: TeX vision over equalised thermal image",
            ("0.0788 / 0.0170 = 4.6", PAPER[0] / PAPER[1]),
            (
                format!(
                    "{} / {} = {}",
                    significant(deviation(tex), 3),
                    significant(deviation(agc), 3),
                    significant(ratio, 2)
                ),
                ratio,
            ),
            (0.2, true),
            format!(
                "another scene: the paper's cubes are not to be had; equalisation by CLAHE of both. With noise the deviation is {} times that without (TeX vision), {} times (thermal)",
                noise(tex),
                noise(agc)
            ),
        ),
        Line::new(
            "Ext. Data Fig. 5",
            "TeX vision has more texture than the equalised thermal image, by the standard deviation",
            "yes",
            if ratio > 1.0 { "yes" } else { "no" },
            if ratio > 1.0 { Verdict::UnderAChoice } else { Verdict::NotReproduced },
            "of a scene of our own",
        ),
        Line::new(
            "Ext. Data Fig. 5",
            "the same read as what ranging can make of it: information of windows on the ground, texture X over equalised thermal image",
            "-",
            times(information("texture X") / information(agc)),
            Verdict::NotInThePaper,
            "S37 with the deviation that the fit gives the texture: a ratio of standard deviations says nothing of it",
        ),
        Line::new(
            "not in the paper",
            "equalising the thermal image: its standard deviation; its information without levels, in 256 levels (ground, median)",
            "-",
            format!("{}; {}, {}", times(raised), times(1.0), times(kept)),
            Verdict::NotInThePaper,
            format!(
                "contrast rises, information never: a rising map steepens noise as it does texture, and levels take some; pixels that would carry more information: {}",
                found.violations
            ),
        ),
        Line::new(
            "not in the paper",
            "information over that of the heat cube (ground, median): thermal image, temperature and lighting together, texture X, distilled texture",
            "-",
            ["thermal image", "temperature and lighting", "texture X", "distilled texture"]
                .map(over)
                .join(", "),
            Verdict::NotInThePaper,
            "the cube has the most; no decomposition can exceed it",
        ),
        Line::new(
            "SIII D",
            "pseudo-TeX vision shows no more than the thermal image",
            "no more than the original thermal vision",
            times(information("pseudo-TeX") / information("thermal image")),
            if information("pseudo-TeX") <= information("thermal image") {
                Verdict::Reproduced
            } else {
                Verdict::NotReproduced
            },
            "all of its channels are made of the thermal image",
        ),
        Line::new(
            "Figs. S13, S14, S33",
            "mean standard deviations of 0.077 against 0.027, 4.6 times, 0.0975 to 0.1553",
            "0.077 / 0.027; 4.6; 0.0975, 0.0624, 0.1553",
            "-",
            Verdict::NotReproduced,
            "of measured images that are not to be had",
        ),
    ]
}
