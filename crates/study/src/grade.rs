//! How sure a verdict is: by the weakest of what it rests on.

use crate::condition::Condition;

hadar::named! {
    /// How strong the evidence of a verdict is, the strongest first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Grade {
        /// It holds for all scenes, or one scene shows that it does not.
        Proved = "proved",
        /// The worst scene was searched, and no worse one is excluded.
        Searched = "searched",
        /// Found by draws.
        Simulated = "simulated",
        /// It rests on something that nobody states.
        Assumed = "assumed",
        /// Nothing can be said.
        NotStated = "not stated",
    }
    /// Its name, e.g. `proved`.
    name
}

impl Grade {
    /// The same of what rests on such conditions too.
    pub(crate) fn under(self, conditions: &[Condition]) -> Self {
        if Condition::open(conditions).next().is_some() { self.max(Self::Assumed) } else { self }
    }
}
