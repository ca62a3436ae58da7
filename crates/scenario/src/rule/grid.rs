//! The `[[grid]]` of a rule: the table that a maker hands in cell by cell, clause by clause, speed by speed, light by light.
//!
//! Each is one light: a `name`, the `lighting` and `surroundings` that stand in the place of those of the envelope (silent: these), and the
//! `speed_step` that cuts the speeds of each `[stop]`, from the lowest on; the highest is a cell of its own. A cell is a clause of its own
//! ([`super::Rule::of_cells`]), judged as every clause is.

use super::clause::Clause;
use super::demand::Demand;
use crate::entries::Entries;
use crate::envelope::Envelope;
use crate::section::{Entry, Section};
use hadar::error::{Error, Place, Result};
use hadar::units::Dimension;

/// Most cells of a rule.
const MOST: usize = 1000;
/// Share of a step by which the highest speed may miss it: rounding.
const SAME: f64 = 1e-9;

/// A light of the grid, at every speed.
#[derive(Debug, Clone, PartialEq)]
pub struct GridLight {
    /// What it is called.
    pub name: String,
    /// From one speed to the next, m s⁻¹.
    pub speed_step_m_s: f64,
    /// Lighting factor of every environment object; the envelope's where `None`.
    pub lighting: Option<Vec<[f64; 2]>>,
    /// Temperature of every environment object, K; the envelope's where `None`.
    pub surroundings_k: Option<Vec<[f64; 2]>>,
}

/// Where a cell stands in the table: a clause at one speed, in one light.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct GridPlace {
    /// Name of the clause; none of a rule without clauses.
    pub clause: Option<String>,
    /// The light; none of a clause that light does not touch.
    pub light: Option<String>,
    /// Speed of the vehicle, m s⁻¹.
    pub speed_m_s: f64,
}

impl GridLight {
    pub(super) fn entries(&self) -> Entries {
        let Self { name, speed_step_m_s, lighting, surroundings_k } = self;
        let lit = Envelope {
            lighting: lighting.clone(),
            surroundings_k: surroundings_k.clone(),
            ..Envelope::default()
        };
        Entries::default()
            .put("name", name.as_str())
            .put_quantity("speed_step", Dimension::Speed, Some(*speed_step_m_s))
            .and(lit.lights())
    }

    /// The speeds of a range, cut from the lowest on.
    fn speeds_m_s(&self, [slowest, fastest]: [f64; 2]) -> Vec<f64> {
        let steps = ((fastest - slowest) / self.speed_step_m_s - SAME).ceil().max(0.0);
        // More than that are refused in any case.
        let steps = steps.min(MOST as f64) as usize;
        let below = (0..steps).map(|step| slowest + step as f64 * self.speed_step_m_s);
        below.chain([fastest]).collect()
    }
}

/// The lights of a rule's grid.
pub(super) fn read(root: &Section<'_>, objects: usize) -> Result<Vec<GridLight>> {
    let Some(entry) = root.get("grid") else { return Ok(Vec::new()) };
    let items = entry.items("each light of the grid as [[grid]], in double brackets")?;
    let mut lights: Vec<GridLight> = Vec::with_capacity(items.len());
    for item in &items {
        let light = one(item, objects)?;
        if lights.iter().any(|other| other.name == light.name) {
            let error = Error::malformed("another light has this name", "give it a name of its own");
            return Err(item.section()?.fail("name", error));
        }
        lights.push(light);
    }
    Ok(lights)
}

fn one(item: &Entry<'_>, objects: usize) -> Result<GridLight> {
    let section = item.section()?;
    let name = section.require("name")?.name("\"night\"")?;
    let speed_step_m_s = section.require("speed_step")?.quantity()?;
    let lit = Envelope::lit(&section, objects)?;
    Ok(GridLight { name, speed_step_m_s, lighting: lit.lighting, surroundings_k: lit.surroundings_k })
}

/// A clause for each cell of a grid, and the cells; `place` tells where a key stands.
///
/// # Errors
/// No clause with speeds; a clause with another number of surroundings; too many cells; a light in which not all scenes are lit as is known.
pub(super) fn cells(
    clauses: &[Clause],
    grid: &[GridLight],
    place: &dyn Fn(&str) -> Place,
) -> Result<(Vec<Clause>, Vec<GridPlace>)> {
    let refused =
        |found: &str, instead: &str, key: &str| Err(Error::malformed(found, instead).at(place(key)));
    if grid.is_empty() {
        let instead = "write [[grid]] with name = \"night\" and speed_step = \"10 km/h\"";
        return refused("the rule has no grid", instead, "");
    }
    let (mut made, mut cells) = (Vec::new(), Vec::new());
    for clause in clauses {
        let Some(stop) = &clause.stop else { continue };
        // Geometry has no light, and a street one of its own.
        let is_lit = !matches!(clause.demand, Demand::Resolution { .. } | Demand::DepthError(_));
        let lights = if is_lit { grid.len() } else { 1 };
        for (index, light) in grid.iter().enumerate().take(lights) {
            let key = format!("grid[{index}]");
            for speed_m_s in light.speeds_m_s(stop.figures().speeds_m_s) {
                if cells.len() == MOST {
                    let found = format!("more than {MOST} cells");
                    return refused(&found, "write a longer step", &format!("{key}.speed_step"));
                }
                let own = clause.name.as_deref().unwrap_or_default();
                let name = Some(format!("{own} {} {speed_m_s}", light.name));
                let mut cell = Clause { name, stop: Some(stop.at(speed_m_s)?), ..clause.clone() };
                if is_lit {
                    cell.lit_by(light).map_err(|error| error.at(place(&key)))?;
                }
                made.push(cell);
                let light = is_lit.then(|| light.name.clone());
                cells.push(GridPlace { clause: clause.name.clone(), light, speed_m_s });
            }
        }
    }
    if cells.is_empty() {
        return refused("no clause has a speed", "write [stop], of which the grid has the speeds", "grid");
    }
    Ok((made, cells))
}

impl Clause {
    /// The same in another light.
    fn lit_by(&mut self, light: &GridLight) -> Result<()> {
        let objects = self.scenario.environment.len();
        for ranges in [&light.lighting, &light.surroundings_k].into_iter().flatten() {
            if ranges.len() != objects {
                let name = self.name.as_deref().unwrap_or_default();
                let found =
                    format!("a light of {} surroundings for {name}, which has {objects}", ranges.len());
                return Err(Error::malformed(found, "give such a clause a rule of its own"));
            }
        }
        let envelope = self.scenario.envelope.get_or_insert_default();
        if let Some(lighting) = &light.lighting {
            envelope.lighting = Some(lighting.clone());
        }
        if let Some(surroundings_k) = &light.surroundings_k {
            envelope.surroundings_k = Some(surroundings_k.clone());
        }
        self.lit_as_known()
    }
}
