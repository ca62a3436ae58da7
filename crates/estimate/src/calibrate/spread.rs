//! Bands that were looked at, among all of a cube.

/// Values of some bands among all of them, `none` for the others.
pub(super) fn spread<T: Clone>(values: Vec<T>, of: &[usize], bands: usize, none: T) -> Vec<T> {
    let mut all = vec![none; bands];
    for (band, value) in of.iter().zip(values) {
        if let Some(place) = all.get_mut(*band) {
            *place = value;
        }
    }
    all
}
