//! Derivative along x of a row of counts.

/// How ∂N/∂x is taken on a grid of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Derivative {
    /// (N[x+1] − N[x−1])/2.
    #[default]
    Central,
    /// Five taps, Farid and Simoncelli.
    Simoncelli,
    /// Of the interpolating cubic spline.
    CubicSpline,
    /// Of the trigonometric interpolation.
    Fourier,
}

impl Derivative {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Central, Self::Simoncelli, Self::CubicSpline, Self::Fourier];

    /// The name in a scenario.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Central => "central",
            Self::Simoncelli => "simoncelli",
            Self::CubicSpline => "cubic-spline",
            Self::Fourier => "fourier",
        }
    }
}
