//! Exact images against closed forms.

mod cache;
mod error;
mod filters;
mod mesh;
mod sphere;

use super::{Filter, Hit, Options, Traceable, Truth, render};
use crate::geometry::{Bounds, Camera};
use crate::settings::{Settings, Shading};
use glam::{DVec2, DVec3};

const GAUSSIAN: Filter = Filter::Gaussian { variance: 1.0 };

/// A flat picture of `size` px; `paint` gives the albedo at a position in px, or nothing.
struct Flat<F> {
    size: [u32; 2],
    paint: F,
}

impl<F: Fn(DVec2) -> Option<f64> + Sync> Flat<F> {
    /// From above, one unit per pixel.
    fn camera(&self) -> Camera {
        let [width, height] = self.size.map(f64::from);
        let view = [DVec3::new(0.0, 0.0, 10.0), DVec3::ZERO, DVec3::Y];
        Camera::orthographic(view, height, width / height, [1.0, 20.0]).unwrap()
    }

    fn render(&self, options: &Options) -> Truth {
        let settings = Settings { shading: Shading::Colour, ..Default::default() };
        render(self, &self.camera(), &settings, self.size, options, &()).unwrap()
    }
}

impl<F: Fn(DVec2) -> Option<f64> + Sync> Traceable for Flat<F> {
    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let t = -origin.z / direction.z;
        let place = origin + t * direction;
        let [width, height] = self.size.map(f64::from);
        let albedo = (self.paint)(DVec2::new(place.x + 0.5 * width, 0.5 * height - place.y))?;
        Some(Hit { t, normal: DVec3::Z, albedo: Some([albedo; 3]) })
    }

    fn bounds(&self) -> Bounds {
        let half = DVec3::new(0.5 * f64::from(self.size[0]), 0.5 * f64::from(self.size[1]), 0.0);
        Bounds::of_box(-half, half)
    }
}

/// Centre of pixel `index`.
fn centre(index: usize, size: [u32; 2]) -> DVec2 {
    let width = size[0] as usize;
    DVec2::new((index % width) as f64 + 0.5, (index / width) as f64 + 0.5)
}
