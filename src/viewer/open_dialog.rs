//! Dialog that opens a scene's file, a built-in scene or a camera by its name.

use egui::{Event, Id, Key, Label, RichText, ScrollArea, TextEdit, Ui, Window};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use surfel::formats;
use surfel::load::scene;

/// Id of the text field.
const FIELD: &str = "open";

/// The dialog: a folder, and the name that is typed in it.
pub struct OpenDialog {
    /// The folder that names are relative to.
    folder: PathBuf,
    text: String,
    /// The folder that was listed last, and the names of its folders and of its files that can be opened.
    listed: Option<(PathBuf, Vec<String>)>,
}

/// Result of the dialog.
pub enum DialogResult {
    Open(String),
    Cancelled,
}

impl OpenDialog {
    /// A dialog that starts in a folder.
    pub fn in_folder(folder: &Path) -> Self {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.into());
        Self { folder, text: String::new(), listed: None }
    }

    /// Shows the dialog; returns its result once there is one.
    pub fn show(&mut self, ui: &mut Ui) -> Option<DialogResult> {
        self.refresh();
        let mut result = None;
        Window::new("Open").collapsible(false).default_width(420.0).show(ui.ctx(), |ui| {
            ui.label(format!(
                "Points ({}), a camera (.json), or a built-in scene such as scene:bumpy-sphere.",
                formats::names()
            ));
            ui.add(Label::new(RichText::new(self.folder.display().to_string()).weak()).truncate());
            let early = self.take_early(ui);
            let field = TextEdit::singleline(&mut self.text).id(Id::new(FIELD)).desired_width(f32::INFINITY);
            let field = ui.add(field);
            let enter = ui.input(|input| input.key_pressed(Key::Enter));
            if enter && (early || field.lost_focus()) && !self.text.is_empty() {
                result = self.choose(&self.text.clone());
            } else if ui.input(|input| input.key_pressed(Key::Escape)) {
                result = Some(DialogResult::Cancelled);
            } else if !field.has_focus() {
                field.request_focus();
            }
            result = self.list(ui).or(result.take());
        });
        result
    }

    /// Takes text that was typed before the field had the focus, which may be a slow frame later; returns whether it had none yet.
    fn take_early(&mut self, ui: &Ui) -> bool {
        let early = !ui.memory(|memory| memory.has_focus(Id::new(FIELD)));
        if early {
            ui.input(|input| {
                // Text before the key that opened the dialog is not meant for it.
                let opened = input.events.iter().rposition(|event| {
                    matches!(event, Event::Key { key: Key::O, pressed: true, modifiers, .. } if modifiers.command)
                });
                for event in &input.events[opened.map_or(0, |opened| opened + 1)..] {
                    if let Event::Text(text) = event {
                        self.text.push_str(text);
                    }
                }
            });
        }
        early
    }

    /// Lists the names that begin with the text.
    fn list(&mut self, ui: &mut Ui) -> Option<DialogResult> {
        let names = self.listed.as_ref().map_or(&[][..], |(_, names)| names);
        let (folder, begin) = split(&self.text);
        let found: Vec<_> = names.iter().filter(|name| name.starts_with(begin)).collect();
        let mut chosen = None;
        ScrollArea::vertical().max_height(240.0).show(ui, |ui| {
            for name in &found {
                if ui.selectable_label(false, *name).clicked() {
                    chosen = Some(format!("{folder}{name}"));
                }
            }
        });
        if found.is_empty() && !is_built_in(&self.text) {
            ui.weak("No folder and no file that can be opened begins like this.");
        }
        self.choose(&chosen?)
    }

    /// Opens what has this name, or enters it if it is a folder.
    fn choose(&mut self, name: &str) -> Option<DialogResult> {
        let name = expand_home(name);
        let path = self.folder.join(&name);
        if path.is_dir() && !is_built_in(&name) {
            self.folder = path.canonicalize().unwrap_or(path);
            self.text.clear();
            return None;
        }
        let is_as_typed = is_built_in(&name) || std::env::current_dir().is_ok_and(|now| now == self.folder);
        Some(DialogResult::Open(if is_as_typed { name } else { path.to_string_lossy().into_owned() }))
    }

    /// Lists the folder of the text if it is another than before.
    fn refresh(&mut self) {
        let folder = self.folder.join(expand_home(split(&self.text).0));
        if self.listed.as_ref().is_none_or(|(listed, _)| *listed != folder) {
            let mut names = list_folder(&folder);
            if folder.parent().is_some() {
                names.insert(0, "../".into());
            }
            self.listed = Some((folder, names));
        }
    }
}

/// Whether a name is that of a built-in scene.
fn is_built_in(name: &str) -> bool {
    scene(OsStr::new(name)).is_some()
}

/// Expands a leading `~` to the user's home folder, as a shell does.
fn expand_home(name: &str) -> String {
    let below = name.strip_prefix('~').filter(|below| below.is_empty() || below.starts_with('/'));
    match below.zip(std::env::home_dir()) {
        Some((below, home)) => format!("{}{below}", home.display()),
        None => name.into(),
    }
}

/// Splits a path into its folder, with the slash, and the name.
fn split(text: &str) -> (&str, &str) {
    text.split_at(text.rfind('/').map_or(0, |slash| slash + 1))
}

/// Names of the folders and of the files that can be opened, sorted. Folders end in a slash.
fn list_folder(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<_> = entries
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok().filter(|name| !name.starts_with('.'))?;
            if entry.path().is_dir() {
                return Some(format!("{name}/"));
            }
            let extension = Path::new(&name).extension()?.to_ascii_lowercase();
            (extension == "json" || formats::extensions().any(|known| extension == known)).then_some(name)
        })
        .collect();
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leading_tilde_is_the_home_folder() {
        let home = std::env::home_dir().unwrap().display().to_string();
        assert_eq!(expand_home("~/a.ply"), format!("{home}/a.ply"));
        assert_eq!(
            ["~", "a/~/b", "~b.ply", "scene:sphere"].map(expand_home),
            [&home, "a/~/b", "~b.ply", "scene:sphere"]
        );
    }

    #[test]
    fn files_that_can_be_opened_are_listed_by_name() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("scans")).unwrap();
        for name in ["b.PLY", "a.json", "c.pdf", ".hidden.ply", "none"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        assert_eq!(list_folder(folder.path()), ["a.json", "b.PLY", "scans/"]);
        assert!(list_folder(&folder.path().join("not there")).is_empty());
        assert_eq!(split("a/b/c"), ("a/b/", "c"));
        assert_eq!(split("c"), ("", "c"));
    }

    #[test]
    fn folders_are_entered_and_files_are_opened() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        std::fs::create_dir(root.join("scans")).unwrap();
        let mut dialog = OpenDialog::in_folder(&root);
        let mut choose = |text: &str| {
            dialog.text = text.into();
            dialog.refresh();
            let chosen = match dialog.choose(text) {
                Some(DialogResult::Open(name)) => Some(name),
                _ => None,
            };
            (chosen, dialog.folder.clone(), dialog.listed.clone().unwrap().1)
        };
        let path = |name: &str| Some(root.join(name).to_str().unwrap().to_owned());
        assert_eq!(choose("sc"), (path("sc"), root.clone(), vec!["../".into(), "scans/".into()]));
        assert_eq!(choose("scans"), (None, root.join("scans"), vec!["../".into(), "scans/".into()]));
        assert_eq!(choose("a.ply").0, path("scans/a.ply"));
        // An absolute path, which is pasted, is not appended to the folder.
        assert_eq!(choose("/b/c.ply").0.as_deref(), Some("/b/c.ply"));
        assert_eq!(choose("scene:sphere").0.as_deref(), Some("scene:sphere"));
        assert_eq!(choose("../").1, root);
        let mut current = OpenDialog::in_folder(Path::new("."));
        assert!(matches!(current.choose("a.ply"), Some(DialogResult::Open(name)) if name == "a.ply"));
    }
}
