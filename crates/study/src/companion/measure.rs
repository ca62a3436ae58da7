//! What can be told in a companion table: measures, what each is worth, its caveat, and why a number may be missing.

hadar::named! {
    /// What a number is worth.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Kind {
        /// Practice without a proof or an observer.
        RuleOfThumb = "rule-of-thumb",
        /// What people before a display did, on the average.
        ObserverModel = "observer-model",
        /// What no algorithm exceeds.
        Bound = "bound",
    }
    /// Stable code, e.g. `rule-of-thumb`.
    code
}

hadar::named! {
    /// What is told in a row; kind, quantities and caveat follow from it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Measure {
        /// Pixels and cycles across the target.
        PixelsOnTarget = "pixels-on-target",
        /// The same by the field of view, where that contradicts the focal length.
        PixelsByFieldOfView = "pixels-by-field-of-view",
        /// Range by Johnson's cycles.
        JohnsonRange = "johnson-range",
        /// Range by the pixels that makers ask.
        IndustryRange = "industry-range",
        /// Noise-equivalent temperature difference of a frame.
        Netd = "netd",
        /// Target transfer probability: the share of observers who are right.
        Ttpf = "ttpf",
        /// Minimum resolvable temperature difference.
        Mrtd = "mrtd",
        /// What a pixel tells of the material.
        Material = "material",
        /// What all pixels of the target tell of it.
        MaterialOfAllPixels = "material-of-all-pixels",
    }
    /// Stable code, e.g. `johnson-range`.
    code
}

impl Measure {
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

hadar::named! {
    /// What the reader of a row must know.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Caveat {
        /// Geometry alone.
        Geometry = "geometry",
        /// Two angles of a pixel.
        FieldOfViewDiffers = "field-of-view-differs",
        /// Comparing by NETD.
        NetdAlone = "netd-alone",
        /// People at displays.
        Observers = "observers",
        /// The eye in a constant.
        Mrtd = "mrtd",
        /// A limit.
        Limit = "limit",
        /// A limit for a target that is the same all over.
        AllAlike = "all-alike",
    }
    /// Stable code, e.g. `netd-alone`.
    code
}

hadar::named! {
    /// Why there is no number.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Unknown {
        /// No camera.
        NoCamera = "no-camera",
        /// No critical dimension.
        NoSize = "no-size",
        /// No distance.
        NoDistance = "no-distance",
        /// The camera counts nothing of a blackbody at the temperature of the NETD.
        NoLight = "no-light",
        /// Sizes and distances whose quotient no number holds.
        BeyondNumbers = "beyond-numbers",
        /// A pattern finer than the pixels sample.
        FinerThanPixels = "finer-than-pixels",
        /// A pattern of which the lens leaves nothing.
        FinerThanLens = "finer-than-lens",
        /// Nothing was told from anything.
        NotCompared = "not-compared",
    }
    /// Stable code, e.g. `no-size`.
    code
}
