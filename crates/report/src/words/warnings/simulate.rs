//! Simulations: what is drawn, learnt and estimated.

use super::block::{short, words};
use hadar::words::significant;

words! {
    PriorsLeftOut {
        meaning: "Priors are not used in what is drawn and learnt.",
        remedy: "Compare with limits without priors.",
        PriorsLeftOut => "priors are left out: neither the drawn spectra nor what is learnt from them uses them",
    }
    SpectraEmpty {
        meaning: "With so few photons most spectra are empty.",
        remedy: "Ask for more with --photons.",
        SpectraEmpty { photons } => {
            format!("with {} photons most spectra are empty in every band", significant(*photons, 3))
        },
    }
    CountsRounded {
        meaning: "Counts are so large that floating point rounds them.",
        remedy: "Ask for fewer with --photons.",
        CountsRounded { photons } => format!(
            "with {} photons counts of a band exceed the integers that 64-bit floating point can hold: \
             they are rounded",
            short(*photons)
        ),
    }
    FewSpectra {
        meaning: "There are too few training spectra to learn from.",
        remedy: "Raise --spectra.",
        FewSpectra { training } => format!("{training} training spectra of each class are too few to learn from"),
    }
    ModelPhotons {
        meaning: "A saved model was trained with another number of photons.",
        remedy: "Judge it with the photons it was trained with, or train anew.",
        ModelPhotons { method, photons } => format!(
            "the saved {} was trained with {} photons: with others its scale is wrong",
            method.words(),
            significant(*photons, 4)
        ),
    }
    NormalLikelihood {
        meaning: "Likelihoods take counts as normal, which is not exact, so that the likelihood \
            ratio may lose a little.",
        remedy: "Ask for more photons, or leave the electronic noise out.",
        NormalLikelihood { error } => format!(
            "likelihoods take counts for normal; their distribution function is up to {} off, so the \
             likelihood ratio may fall short of the optimum (draws are exact)",
            short(*error)
        ),
    }
    LimitNormal {
        meaning: "With a fixed total only the limit of many photons is known: nothing is compared with it.",
        remedy: "Use --statistics poisson to hold classifiers against their limit.",
        LimitNormal => "with a fixed total only the limit of many photons is known; nothing is compared with it",
    }
    RangeHoldsTheEstimates {
        meaning: "Fits end at the edge of what is physically possible and may be biased, where the \
            Cramer-Rao bound says nothing.",
        remedy: "Use more photons or bands, or know the lighting.",
        RangeHoldsTheEstimates { at_edge, held } => format!(
            "up to {:.1} % of the fits at a temperature end at the edge of the physical range of lighting or temperature: \
             they may be biased, and the range limits their errors, so that the Cramer-Rao bound, which is for unbiased \
             estimates, is not applied where more than {:.1} % do",
            100.0 * at_edge,
            100.0 * held
        ),
    }
    UnconvergedFits {
        meaning: "Fits of temperatures did not converge.",
        remedy: "Nothing if they are few; else take more photons or bands.",
        UnconvergedFits { fits } => {
            format!("{fits} fits did not converge; their best state so far counts")
        },
    }
    NoReading {
        meaning: "Sums of counts are explained by no temperature.",
        remedy: "Take more photons: noise outweighs the signal.",
        NoReading { sums } => {
            format!("{sums} sums of counts are explained by no temperature; thermal imaging is without them")
        },
    }
    TemperatureNotSeen {
        meaning: "The spectrum holds no information on the temperature that the other unknowns do not imitate.",
        remedy: "Take more bands, or make an unknown known.",
        TemperatureNotSeen => "the spectrum holds no information on the temperature, or none that the other unknowns do not imitate",
    }
}
