//! What can be told in a companion table: measures, what each is worth, its caveat, and why a number may be missing.

/// What a number is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Practice without a proof or an observer.
    RuleOfThumb,
    /// What people before a display did, on the average.
    ObserverModel,
    /// What no algorithm exceeds.
    Bound,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::RuleOfThumb, Self::ObserverModel, Self::Bound];

    /// Stable code, e.g. `rule-of-thumb`.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::RuleOfThumb => "rule-of-thumb",
            Self::ObserverModel => "observer-model",
            Self::Bound => "bound",
        }
    }
}

/// What is told in a row; kind, quantities and caveat follow from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Pixels and cycles across the target.
    PixelsOnTarget,
    /// The same by the field of view, where that contradicts the focal length.
    PixelsByFieldOfView,
    /// Range by Johnson's cycles.
    JohnsonRange,
    /// Range by the pixels that makers ask.
    IndustryRange,
    /// Noise-equivalent temperature difference of a frame.
    Netd,
    /// Target transfer probability: the share of observers who are right.
    Ttpf,
    /// Minimum resolvable temperature difference.
    Mrtd,
    /// What a pixel tells of the material.
    Material,
    /// What all pixels of the target tell of it.
    MaterialOfAllPixels,
}

impl Measure {
    /// Stable code, e.g. `johnson-range`.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::PixelsOnTarget => "pixels-on-target",
            Self::PixelsByFieldOfView => "pixels-by-field-of-view",
            Self::JohnsonRange => "johnson-range",
            Self::IndustryRange => "industry-range",
            Self::Netd => "netd",
            Self::Ttpf => "ttpf",
            Self::Mrtd => "mrtd",
            Self::Material => "material",
            Self::MaterialOfAllPixels => "material-of-all-pixels",
        }
    }

    /// What it is worth.
    #[must_use]
    pub const fn kind(self) -> Kind {
        match self {
            Self::PixelsOnTarget
            | Self::PixelsByFieldOfView
            | Self::JohnsonRange
            | Self::IndustryRange
            | Self::Netd => Kind::RuleOfThumb,
            Self::Ttpf | Self::Mrtd => Kind::ObserverModel,
            Self::Material | Self::MaterialOfAllPixels => Kind::Bound,
        }
    }

    /// What its reader must know.
    #[must_use]
    pub const fn caveat(self) -> Caveat {
        match self {
            Self::PixelsOnTarget | Self::JohnsonRange | Self::IndustryRange => Caveat::Geometry,
            Self::PixelsByFieldOfView => Caveat::FieldOfViewDiffers,
            Self::Netd => Caveat::NetdAlone,
            Self::Ttpf => Caveat::Observers,
            Self::Mrtd => Caveat::Mrtd,
            Self::Material => Caveat::Limit,
            Self::MaterialOfAllPixels => Caveat::AllAlike,
        }
    }

    /// Keys of its values, with their units.
    #[must_use]
    pub const fn quantities(self) -> &'static [&'static str] {
        match self {
            Self::PixelsOnTarget | Self::PixelsByFieldOfView => &["pixels", "cycles"],
            Self::JohnsonRange | Self::IndustryRange => &["range_m"],
            Self::Netd => &["netd_k"],
            Self::Ttpf => &["probability"],
            Self::Mrtd => &["mrtd_k"],
            Self::Material | Self::MaterialOfAllPixels => &["statistical_distance", "detection_probability"],
        }
    }
}

/// What the reader of a row must know.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Caveat {
    /// Geometry alone.
    Geometry,
    /// Two angles of a pixel.
    FieldOfViewDiffers,
    /// Comparing by NETD.
    NetdAlone,
    /// People at displays.
    Observers,
    /// The eye in a constant.
    Mrtd,
    /// A limit.
    Limit,
    /// A limit for a target that is the same all over.
    AllAlike,
}

impl Caveat {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Geometry,
        Self::FieldOfViewDiffers,
        Self::NetdAlone,
        Self::Observers,
        Self::Mrtd,
        Self::Limit,
        Self::AllAlike,
    ];

    /// Stable code, e.g. `netd-alone`.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::Geometry => "geometry",
            Self::FieldOfViewDiffers => "field-of-view-differs",
            Self::NetdAlone => "netd-alone",
            Self::Observers => "observers",
            Self::Mrtd => "mrtd",
            Self::Limit => "limit",
            Self::AllAlike => "all-alike",
        }
    }
}

/// Why there is no number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unknown {
    /// No camera.
    NoCamera,
    /// No critical dimension.
    NoSize,
    /// No distance.
    NoDistance,
    /// The camera counts nothing of a blackbody at the temperature of the NETD.
    NoLight,
    /// Sizes and distances whose quotient no number holds.
    BeyondNumbers,
    /// A pattern finer than the pixels sample.
    FinerThanPixels,
    /// A pattern of which the lens leaves nothing.
    FinerThanLens,
    /// Nothing was told from anything.
    NotCompared,
}

impl Unknown {
    /// Stable code, e.g. `no-size`.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::NoCamera => "no-camera",
            Self::NoSize => "no-size",
            Self::NoDistance => "no-distance",
            Self::NoLight => "no-light",
            Self::BeyondNumbers => "beyond-numbers",
            Self::FinerThanPixels => "finer-than-pixels",
            Self::FinerThanLens => "finer-than-lens",
            Self::NotCompared => "not-compared",
        }
    }
}
