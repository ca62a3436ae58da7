//! What the amplitudes of the alternative's sources may be, and the least of a linear cost over them.
//!
//! The alternative is a sum of sources: its surface with amplitude c₀ (the gain) and object k with cₖ = c₀Vₖ. A source of
//! unknown temperature stands in it by two *pieces*, its spectra at both ends of an interval. The amplitudes fulfil
//!
//! lₖ ≤ Vₖ ≤ uₖ,  ΣVₖ ≤ s (or = s),  c₀ = 1, or where the gain is free Σ amplitude · length ≤ total,
//!
//! the length of a piece being the sum of its counts. Every set here contains what is allowed, and may be somewhat larger
//! where that is simpler: a least value over it is a lower bound.
//!
//! With c₀ = 1 the least value comes of filling the cheapest pieces first (the constraints are laminar). With a free gain
//! the extreme points are rays cut off at the total, and the cheapest per length is found as Dinkelbach does.
//! Source: W. Dinkelbach, Management Science 13, 492 (1967), doi:10.1287/mnsc.13.7.492.

/// Steps of Dinkelbach's method; each one strictly betters the ray, and there are few.
const STEPS: usize = 50;

/// The pieces of a box: whose they are, how long, how far each may go (without the gain), and at what temperature they are.
#[derive(Debug, Clone, Default)]
pub(super) struct Pieces {
    pub(super) source: Vec<usize>,
    pub(super) length: Vec<f64>,
    pub(super) cap: Vec<f64>,
    pub(super) temperature_k: Vec<f64>,
}

impl Pieces {
    pub(super) fn put(&mut self, source: usize, length: f64, cap: f64, temperature_k: f64) {
        self.source.push(source);
        self.length.push(length);
        self.cap.push(cap);
        self.temperature_k.push(temperature_k);
    }

    pub(super) fn clear(&mut self) {
        self.source.clear();
        self.length.clear();
        self.cap.clear();
        self.temperature_k.clear();
    }
}

/// The set of amplitudes.
#[derive(Debug, Clone)]
pub(super) struct Amplitudes {
    /// Whether c₀ is free.
    pub(super) gain_free: bool,
    /// lₖ and uₖ of every object.
    pub(super) ranges: Vec<[f64; 2]>,
    /// s, and whether the sum is known.
    pub(super) sum: f64,
    pub(super) sum_known: bool,
    /// What all sources together send at most.
    pub(super) total: f64,
    /// Largest c₀, where one is set.
    pub(super) gain_cap: Option<f64>,
}

/// Memory of [`Amplitudes::least`].
#[derive(Debug, Clone, Default)]
pub(super) struct Ray {
    cost: Vec<f64>,
    vertex: Vec<f64>,
}

impl Amplitudes {
    /// Least Σ cost · amplitude, and where it is.
    pub(super) fn least(&self, pieces: &Pieces, cost: &[f64], vertex: &mut [f64], ray: &mut Ray) -> f64 {
        if !self.gain_free {
            return self.ray(pieces, cost, vertex);
        }
        let mut value = self.ray(pieces, cost, vertex);
        if let Some(cap) = self.gain_cap {
            let scale = if value < 0.0 { cap } else { 0.0 };
            vertex.iter_mut().for_each(|v| *v *= scale);
            return scale * value;
        }
        if value >= 0.0 {
            vertex.fill(0.0);
            return 0.0;
        }
        let along = |vertex: &[f64], x: &[f64]| -> f64 { vertex.iter().zip(x).map(|(v, x)| v * x).sum() };
        let mut length = along(vertex, &pieces.length);
        ray.cost.resize(cost.len(), 0.0);
        ray.vertex.resize(cost.len(), 0.0);
        for _ in 0..STEPS {
            if length <= 0.0 {
                break;
            }
            let rate = value / length;
            for ((adjusted, cost), length) in ray.cost.iter_mut().zip(cost).zip(&pieces.length) {
                *adjusted = cost - rate * length;
            }
            if self.ray(pieces, &ray.cost, &mut ray.vertex) >= -1e-15 * value.abs() {
                break;
            }
            vertex.copy_from_slice(&ray.vertex);
            (value, length) = (along(vertex, cost), along(vertex, &pieces.length));
        }
        let scale = if length > 0.0 { self.total / length } else { 0.0 };
        vertex.iter_mut().for_each(|v| *v *= scale);
        scale * value
    }

    /// With c₀ = 1; caps hold where that is the gain.
    fn ray(&self, pieces: &Pieces, cost: &[f64], vertex: &mut [f64]) -> f64 {
        vertex.fill(0.0);
        let order = |&i: &usize, &j: &usize| cost[i].total_cmp(&cost[j]).then(i.cmp(&j));
        let cheapest = |source: usize| {
            let own = (0..cost.len()).filter(|&i| pieces.source[i] == source);
            own.min_by(order)
        };
        let mut value = 0.0;
        let mut put = |vertex: &mut [f64], i: usize, amount: f64| {
            vertex[i] += amount;
            value += amount * cost[i];
        };
        if let Some(i) = cheapest(0) {
            put(vertex, i, 1.0);
        }
        let mut left = self.sum;
        for (k, [low, _]) in self.ranges.iter().enumerate() {
            left -= low;
            if let (true, Some(i)) = (*low > 0.0, cheapest(k + 1)) {
                put(vertex, i, *low);
            }
        }
        let mut last = None;
        loop {
            // One after the other in the order of their costs.
            let later = |i: &usize| last.as_ref().is_none_or(|last| order(last, i).is_lt());
            let next = (0..cost.len()).filter(|&i| pieces.source[i] > 0).filter(later).min_by(order);
            let Some(i) = next.filter(|&i| left > 0.0 && (cost[i] < 0.0 || self.sum_known)) else { break };
            last = Some(i);
            let source = pieces.source[i];
            let had: f64 = (0..cost.len()).filter(|&j| pieces.source[j] == source).map(|j| vertex[j]).sum();
            let cap = if self.gain_free { f64::INFINITY } else { pieces.cap[i] - vertex[i] };
            let amount = (self.ranges[source - 1][1] - had).min(left).min(cap);
            if amount > 0.0 {
                put(vertex, i, amount);
                left -= amount;
            }
        }
        value
    }
}
