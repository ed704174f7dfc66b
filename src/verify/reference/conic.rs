//! The screen-space ellipse of a disc: by the inverse of its mapping (zwicker2004 sections 4.2 to 4.4), or by the dual
//! conic, which needs no inverse.
//!
//! Both take the mapping of the tangent plane as columns `S, T, X`: the images of the 1-σ axes and of the centre in
//! homogeneous pixel coordinates `(x w, y w, w)`, relative to the projected centre. The paper writes row vectors: its
//! `M` is the transpose of this matrix.

use glam::{DMat2, DMat3, DVec2, DVec3};

/// The affine approximation of a projected kernel, exact on its cut-off ellipse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Conic {
    /// Ellipse centre minus projected centre, px.
    pub offset: DVec2,
    /// Variance `V = Q''⁻¹`, px².
    pub variance: DMat2,
    /// `√|V|`, px².
    pub sqrt_det: f64,
}

/// Largest condition number, after scaling, of a mapping that is inverted. The determinant `a c - b²` of the conic
/// loses relative precision with the square of it: float64 keeps 10⁻¹⁶ · 10⁸ = 10⁻⁸ of V, 10⁻⁵ px on a 1000 px splat. A
/// disc reaches this number at about 89.99°.
pub(super) const WORST_CONDITION: f64 = 1e4;

/// Least `1 - (F |g| / w)²` of a mapping that is inverted. Towards the eye plane the ellipse approaches a parabola,
/// whose determinant is 0, and loses as many digits.
pub(super) const LEAST_CLEARANCE: f64 = 1e-6;

/// Clearance of the cut-off disc from the eye plane: `q = (w / F)² - g·g`; drawable if above 0.
pub(super) fn clearance(mapping: &DMat3, cutoff: f64) -> f64 {
    let [g0, g1, w] = [mapping.x_axis.z, mapping.y_axis.z, mapping.z_axis.z];
    (w / cutoff).powi(2) - g0 * g0 - g1 * g1
}

/// Equations 6, 7, 10 and 11 with `Q' = M⁻¹ Q_h M⁻ᵀ`; `None` if the mapping is too ill-conditioned to be inverted.
pub(super) fn inverse_form(mapping: &DMat3, cutoff: f64) -> Option<Conic> {
    let w = mapping.z_axis.z;
    if clearance(mapping, cutoff) < LEAST_CLEARANCE * (w / cutoff).powi(2) {
        return None;
    }
    let (scaled, columns, unit) = equilibrated(mapping);
    let inverse = scaled.inverse();
    let condition = frobenius(&scaled) * frobenius(&inverse);
    if condition.is_nan() || condition > WORST_CONDITION {
        return None;
    }
    let isocontour = DMat3::from_diagonal(columns * columns * DVec3::new(1.0, 1.0, -cutoff * cutoff));
    let conic = centred(&(inverse.transpose() * isocontour * inverse), cutoff);
    Some(Conic {
        offset: unit * conic.offset,
        variance: unit * unit * conic.variance,
        sqrt_det: unit * unit * conic.sqrt_det,
    })
}

/// Scales the mapping to `R A C`, whose rows and columns are of the order of 1. Returns it, the diagonal of `C`, and
/// its unit in px.
fn equilibrated(mapping: &DMat3) -> (DMat3, DVec3, f64) {
    // The two axes share a factor, and so do the two pixel rows, because their ratio is the ellipse's shape.
    let axes = 1.0 / mapping.x_axis.length().max(mapping.y_axis.length());
    let columns = DVec3::new(axes, axes, 1.0 / mapping.z_axis.length());
    let scaled = *mapping * DMat3::from_diagonal(columns);
    let pixels = scaled.row(0).length().max(scaled.row(1).length());
    let depth = scaled.row(2).length();
    let rows = DVec3::new(1.0 / pixels, 1.0 / pixels, 1.0 / depth);
    (DMat3::from_diagonal(rows) * scaled, columns, pixels / depth)
}

fn frobenius(m: &DMat3) -> f64 {
    m.to_cols_array().iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Centre and variance of the conic `x Q xᵀ = 0` with `Q = [[a,b,d],[b,c,e],[d,e,-f]]`: equations 7, 10 and 11.
fn centred(q: &DMat3, cutoff: f64) -> Conic {
    let [a, b, c] = [q.x_axis.x, q.x_axis.y, q.y_axis.y];
    let [d, e, f] = [q.x_axis.z, q.y_axis.z, -q.z_axis.z];
    let det = a * c - b * b;
    let offset = DVec2::new(b * e - c * d, b * d - a * e) / det;
    let scale = cutoff * cutoff / (f - d * offset.x - e * offset.y);
    let inverse = DMat2::from_cols(DVec2::new(c, -b), DVec2::new(-b, a));
    Conic { offset, variance: inverse * (1.0 / (scale * det)), sqrt_det: 1.0 / (scale * det.sqrt()) }
}

/// The same from sums of squares, which are exact at every angle: `V = (D Dᵀ / q + o oᵀ) / F²`, `o = -D g / q`.
pub(super) fn dual_form(mapping: &DMat3, cutoff: f64) -> Conic {
    let d = DMat2::from_cols(mapping.x_axis.truncate(), mapping.y_axis.truncate());
    let g = DVec2::new(mapping.x_axis.z, mapping.y_axis.z);
    let q = clearance(mapping, cutoff);
    let offset = -(d * g) / q;
    let outer = DMat2::from_cols(offset * offset.x, offset * offset.y);
    let variance = (d * d.transpose() * (1.0 / q) + outer) * (1.0 / (cutoff * cutoff));
    Conic { offset, variance, sqrt_det: mapping.determinant().abs() / (cutoff * q.sqrt()).powi(3) }
}
