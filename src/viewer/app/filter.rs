//! Filter of the panel: which points of the scene's files are read.

use super::{App, LOADING};
use crate::viewer::LoadRequest;

impl App {
    /// Loads the scene again in the background once the user has changed its filter: normals and radii are those of the points that are left, as
    /// `surfel render` estimates them. The scene before stays until then.
    pub(super) fn apply_filter(&mut self) {
        let wanted = &self.state.filter;
        let chosen = self.loading.as_ref().unwrap_or(&self.shown);
        if *wanted == chosen.filter || wanted.classes.as_ref().is_some_and(Vec::is_empty) {
            return;
        }
        if chosen.inputs != self.shown.inputs || !self.state.is_whole() {
            // Another scene is being loaded.
            self.state.filter = chosen.filter.clone();
            return;
        }
        let request = LoadRequest { inputs: self.shown.inputs.clone(), filter: wanted.clone() };
        self.ui_state.loading = Some(LOADING);
        self.loading = Some(request.clone());
        self.loader.start(request, true);
        self.changed();
    }

    /// Shows the filter of the scene that is shown in the panel.
    pub(super) fn reset_filter(&mut self) {
        self.state.filter = self.shown.filter.clone();
    }
}
