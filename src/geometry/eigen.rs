//! Eigenvectors of symmetric 3×3 matrices.

use glam::{DMat3, DVec3};

/// Eigenvalues in ascending order and unit eigenvectors, by cyclic Jacobi rotations: exact to rounding also for equal eigenvalues.
pub(crate) fn symmetric(mut a: DMat3) -> (DVec3, [DVec3; 3]) {
    const SWEEPS: usize = 8;
    let mut vectors = DMat3::IDENTITY;
    for _ in 0..SWEEPS {
        let off = a.x_axis.y.abs() + a.x_axis.z.abs() + a.y_axis.z.abs();
        if off <= f64::EPSILON * (a.x_axis.x.abs() + a.y_axis.y.abs() + a.z_axis.z.abs()) {
            break;
        }
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let rotation = rotation(&a, i, j);
            a = rotation.transpose() * a * rotation;
            vectors *= rotation;
        }
    }
    let mut order = [0, 1, 2];
    let value = |i: usize| a.col(i)[i];
    order.sort_by(|&i, &j| value(i).total_cmp(&value(j)));
    (DVec3::from_array(order.map(value)), order.map(|i| vectors.col(i).normalize_or_zero()))
}

/// The rotation in the plane of axes `i` and `j` that makes entry (i, j) zero (Golub & Van Loan, Matrix Computations, 8.5.2).
fn rotation(a: &DMat3, i: usize, j: usize) -> DMat3 {
    let mut rotation = DMat3::IDENTITY;
    let off = a.col(j)[i];
    if off != 0.0 {
        let tau = (a.col(j)[j] - a.col(i)[i]) / (2.0 * off);
        let t = if tau >= 0.0 { 1.0 } else { -1.0 } / (tau.abs() + (tau * tau + 1.0).sqrt());
        let c = 1.0 / (t * t + 1.0).sqrt();
        let s = t * c;
        rotation.col_mut(i)[i] = c;
        rotation.col_mut(j)[j] = c;
        rotation.col_mut(j)[i] = s;
        rotation.col_mut(i)[j] = -s;
    }
    rotation
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_and_values_give_the_matrix_back() {
        let outer = |v: DVec3, w: f64| w * DMat3::from_cols(v * v.x, v * v.y, v * v.z);
        let (u, v) = (DVec3::new(0.3, -0.5, 0.8).normalize(), DVec3::new(0.8, 0.48, 0.0).normalize());
        let w = u.cross(v).normalize();
        let v = w.cross(u);
        for values in [[1e-9, 0.5, 2.0], [1.0, 1.0, 1.0], [0.0, 0.0, 3.0], [0.0, 1.0, 1.0], [0.0; 3]] {
            let a = outer(u, values[0]) + outer(v, values[1]) + outer(w, values[2]);
            let (found, vectors) = symmetric(a);
            let again = (0..3).fold(DMat3::ZERO, |sum, i| sum + outer(vectors[i], found[i]));
            let error = (again - a).to_cols_array().map(f64::abs).into_iter().fold(0.0, f64::max);
            assert!(error < 1e-14, "{values:?}: {error}");
            assert!((found - DVec3::from_array(values)).abs().max_element() < 1e-14, "{values:?}: {found}");
        }
    }
}
