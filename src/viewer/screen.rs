//! What the window shows beneath its panels: a picture of the scene, or two side by side.

use super::side::{Seen, Side};
use glam::DVec2;
use std::sync::Arc;
use surfel::geometry::{Camera, ValueRange};
use surfel::settings::Shading;
use surfel::vk::{Presented, Presenter};
use surfel::{FrameReport, Rasterizer, Result, Scene, Settings};

/// Renders scenes and shows them.
pub struct Screen {
    left: Side,
    /// Where there have been two pictures.
    right: Option<Side>,
    rasterizer: Option<Rasterizer>,
    asked: Asked,
    /// Whether the last frame drew something anew, and whether things had to be made for that.
    drew: bool,
    made: bool,
}

/// What is asked of frames beside the scene.
#[derive(Clone, Default)]
pub struct Asked {
    /// Whether they tell their times and counts.
    pub measured: bool,
    /// Another for the same scene with other contents.
    pub version: u64,
    /// How the scene is rendered on the right, and where that begins, as part of the width.
    pub split: Option<(Settings, f64)>,
}

/// What the pictures tell that were drawn anew.
pub struct Reports {
    /// Of the only picture, or of the left one.
    pub left: Option<FrameReport>,
    pub right: Option<FrameReport>,
}

/// A place in a window's picture.
#[derive(Clone, Copy, Debug)]
pub struct Pick {
    /// Px.
    pub at: DVec2,
    /// Width and height of the picture, px.
    pub size: [u32; 2],
}

impl Screen {
    /// Nothing is there yet to be shown by `presenter`; nothing is asked.
    pub fn new(presenter: &Presenter, rasterizer: Option<Rasterizer>) -> Result<Self> {
        let left = Side::new(presenter, rasterizer)?;
        Ok(Self { left, right: None, rasterizer, asked: Asked::default(), drew: false, made: false })
    }

    /// What is asked of frames of `presenter` from now on.
    pub fn ask(&mut self, asked: Asked, presenter: &Presenter) -> Result<()> {
        if asked.split.is_some() && self.right.is_none() {
            self.right = Some(Side::new(presenter, self.rasterizer)?);
        }
        self.asked = asked;
        Ok(())
    }

    /// Records a frame of `scene`, if there is one, of `size` px, into an area of the window, px from its top left. After an error that is empty.
    pub fn record(
        &mut self,
        window: &Presented,
        (area, size): ([u32; 2], [u32; 2]),
        scene: Option<(&Arc<Scene>, &Camera, &Settings)>,
    ) -> Result<()> {
        let Asked { measured, version, split } = self.asked.clone();
        let seen = scene.map(|(scene, camera, settings)| Seen {
            scene: scene.clone(),
            camera: *camera,
            settings: settings.clone(),
            size,
            version,
            measured,
        });
        let drawn = self.left.record(window, seen.as_ref());
        self.drew = *drawn.as_ref().unwrap_or(&false);
        self.made = self.left.made();
        let mut drawn = drawn.map(|_| ());
        let (other, divider) = split.filter(|_| seen.is_some()).unzip();
        let divider = divider.unwrap_or(1.0);
        if let Some(((seen, settings), side)) = seen.zip(other).zip(self.right.as_mut()) {
            let right = side.record(window, Some(&Seen { settings, ..seen }));
            self.drew |= *right.as_ref().unwrap_or(&false);
            self.made |= side.made();
            drawn = drawn.and(right.map(|_| ()));
        }
        let right = self.right.as_ref().filter(|_| divider < 1.0);
        // Beside the area is the panel, but its edge may be within a px.
        if area != window.size() || [Some(&self.left), right].into_iter().flatten().any(Side::is_empty) {
            window.clear();
        }
        self.left.show(window, area, [0.0, divider])?;
        if let Some(right) = right {
            right.show(window, area, [divider, 1.0])?;
        }
        drawn
    }

    /// Whether the last frame drew a picture anew, rather than show one that was there.
    pub fn drew(&self) -> bool {
        self.drew
    }

    /// Whether things had to be made for that.
    pub fn made(&self) -> bool {
        self.made
    }

    /// The least and the greatest number that the pictures show, left and right, where they show numbers, and what these are.
    pub fn ranges(&self, presenter: &Presenter) -> Result<[Option<(Shading, ValueRange)>; 2]> {
        let right = self.right.as_ref().filter(|_| self.asked.split.is_some());
        let right = right.map_or(Ok(None), |right| right.range(presenter))?;
        Ok([self.left.range(presenter)?, right])
    }

    /// What the last frame tells, once; nothing where it was not measured.
    pub fn reports(&mut self, presenter: &Presenter) -> Result<Reports> {
        let right = self.right.as_mut().map_or(Ok(None), |right| right.report(presenter))?;
        Ok(Reports { left: self.left.report(presenter)?, right })
    }

    /// The depth of the last frame at a place; `None` where nothing is.
    pub fn pick(&self, Pick { at, size }: Pick, presenter: &Presenter) -> Result<Option<f64>> {
        let Some((own, depths)) = self.left.depths(presenter)? else { return Ok(None) };
        let part = at / DVec2::from(size.map(f64::from));
        let [x, y] = [0, 1].map(|axis| {
            let place = (part[axis] * f64::from(own[axis])).floor();
            (place >= 0.0 && place < f64::from(own[axis])).then_some(place as usize)
        });
        let first = x.zip(y).map(|(x, y)| 4 * (y * own[0] as usize + x));
        let bytes = first.and_then(|first| depths.get(first..first + 4)?.try_into().ok());
        Ok(bytes.map(f32::from_ne_bytes).filter(|depth| *depth > 0.0).map(f64::from))
    }
}
