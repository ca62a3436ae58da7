//! How precisely can two cameras know the depth of a textured wall?
//!
//!     cargo run --release --example depth_bound
//!
//! The texture is a cosine of contrast m, with N photons a pixel on average and k = 2π/5 per pixel. In a window of 5 × 5
//! pixels, one period wide, J = 25 N k² (1 − √(1 − m²)) = 1979 pixel⁻² in closed form, hence an error of the disparity
//! of √(2/J) = 0.0318 pixels and of the depth of z² p √(2/J)/(b f) = 12.3 cm at 30 m. Five
//! pixels a period find J to 2e-4.

use hadar::cube::{MemoryCube, Shape};
use hadar::ranging::depth::{Image, StereoGeometry, WindowInformation};
use hadar::ranging::derivative::Derivative;
use hadar::ranging::information::{Cell, Request, Window, information};
use hadar::ranging::noise::{Joined, NoiseVariance};

fn main() -> hadar::Result<()> {
    // Expected counts of one view: the texture, without noise of its own.
    let (rows, columns, photons, contrast) = (5, 25, 1e4, 0.1);
    let k = std::f64::consts::TAU / 5.0;
    let counts =
        (0..rows * columns).map(|i| photons * (1.0 + contrast * (k * ((i % columns) as f64 + 0.5)).cos()));
    let image = MemoryCube::new(Shape::new(rows, columns, 1)?, counts.collect())?;

    // What a window tells of its place, in shot noise.
    let request = Request {
        window: Window::new(5, 5)?,
        derivative: Derivative::Fourier,
        noise: &NoiseVariance::None,
        joined: Joined::default(),
        cells: &[Cell::Full],
        centres: 0..rows,
    };
    let map = information(&image.into(), &request)?;
    let middle = map.columns.len() / 2;
    let j = map.cell(Cell::Full)[middle];
    let exact = 25.0 * photons * k * k * (1.0 - (1.0 - contrast * contrast).sqrt());
    println!("J = {j:.1} pixel⁻² (closed form {exact:.1})");

    // Both views see the same; 20 cm apart, lenses of 14 mm, pixels of 12 µm.
    let stereo = StereoGeometry::new(0.2, 14e-3, 12e-6)?;
    let window = WindowInformation::new(j, map.photons[middle], map.var_added[middle])?;
    for distance_m in [10.0, 30.0] {
        let bound = stereo.depth_bound(distance_m, [window; 2], Image::Measured)?;
        println!(
            "at {distance_m} m: {:.1} cm at best ({:.4} pixels of disparity)",
            100.0 * bound.sigma_z_m,
            bound.sigma_disparity_px
        );
    }
    Ok(())
}
