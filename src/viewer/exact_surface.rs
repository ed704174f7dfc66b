//! Exact surface of a scene, for the error panel. It is opened when a comparison first needs it: the triangles of a file and their search tree
//! take more memory than its points, so loading leaves them out.

use std::sync::{Arc, Mutex, PoisonError};
use surfel::verify::truth::Traceable;
use surfel::{Progress, Result};

/// A surface that exact pictures can be rendered of.
pub type Surface = Arc<dyn Traceable + Send + Sync>;

/// Opens a surface: reads triangles, or makes that of a built-in scene.
pub type OpenSurface = Arc<dyn Fn(&dyn Progress) -> Result<Surface> + Send + Sync>;

/// An exact surface. Clones share what is opened; it is dropped with the scene.
#[derive(Clone)]
pub struct ExactSurface {
    open: OpenSurface,
    opened: Arc<Mutex<Option<Surface>>>,
}

impl ExactSurface {
    /// A surface that is not opened yet.
    pub fn new(open: OpenSurface) -> Self {
        Self { open, opened: Arc::default() }
    }

    /// The surface, opened if it is not. It takes long and belongs to a background thread.
    ///
    /// # Errors
    /// Those of opening; the next call tries again.
    pub fn get(&self, progress: &dyn Progress) -> Result<Surface> {
        let mut opened = self.opened.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(surface) = &*opened {
            return Ok(surface.clone());
        }
        let surface = (self.open)(progress)?;
        *opened = Some(surface.clone());
        Ok(surface)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use surfel::Error;
    use surfel::verify::scenes;

    #[test]
    fn a_surface_is_opened_once_and_after_an_error_again() {
        let calls = Arc::new(AtomicUsize::new(0));
        let own = calls.clone();
        let surface = ExactSurface::new(Arc::new(move |_| match own.fetch_add(1, Ordering::Relaxed) {
            0 => Err(Error::Cancelled),
            _ => Ok(Arc::new(scenes::surface("scene:sphere")?)),
        }));
        assert_eq!(calls.load(Ordering::Relaxed), 0, "nothing is opened before it is needed");
        assert!(matches!(surface.get(&()), Err(Error::Cancelled)));
        let first = surface.get(&()).unwrap();
        assert!(Arc::ptr_eq(&first, &surface.clone().get(&()).unwrap()));
        assert_eq!(calls.load(Ordering::Relaxed), 2);
    }
}
