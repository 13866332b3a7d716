//! How far two series of numbers are apart.

/// Root of the mean square of the differences.
pub fn rms(pairs: &[(f64, f64)]) -> f64 {
    let squares: f64 = pairs.iter().map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / pairs.len() as f64).sqrt()
}

/// Pearson's correlation; `None` where one of the two does not vary.
pub fn correlation(pairs: &[(f64, f64)]) -> Option<f64> {
    let n = pairs.len() as f64;
    let mean_a = pairs.iter().map(|(a, _)| a).sum::<f64>() / n;
    let mean_b = pairs.iter().map(|(_, b)| b).sum::<f64>() / n;
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (a, b) in pairs {
        aa += (a - mean_a) * (a - mean_a);
        bb += (b - mean_b) * (b - mean_b);
        ab += (a - mean_a) * (b - mean_b);
    }
    let correlation = ab / (aa * bb).sqrt();
    correlation.is_finite().then_some(correlation)
}
