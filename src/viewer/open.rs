//! Opening what is named: a scene's file, a built-in scene, a camera.

use egui::{Event, Id, Key, ScrollArea, TextEdit, Ui, Window};
use std::path::{Path, PathBuf};
use surfel::formats;

/// The field that the name is typed in.
const FIELD: &str = "open";

/// A name that is being typed.
#[derive(Default)]
pub struct Opening {
    text: String,
    /// The folder that was looked into last, and what of it can be opened.
    folder: Option<PathBuf>,
    there: Vec<String>,
}

/// What came of it.
pub enum Answer {
    Open(String),
    Nothing,
}

impl Opening {
    /// Starts in a folder.
    pub fn at(folder: &Path) -> Self {
        let text = if folder == Path::new(".") { String::new() } else { format!("{}/", folder.display()) };
        Self { text, ..Self::default() }
    }

    /// Asks, until there is an answer.
    pub fn show(&mut self, ui: &mut Ui) -> Option<Answer> {
        self.refresh();
        let mut answer = None;
        Window::new("Open").collapsible(false).default_width(420.0).show(ui.ctx(), |ui| {
            ui.label("a PLY file, a camera's .json file, or a scene such as scene:bumpy-sphere");
            let early = self.take_early(ui);
            let field = TextEdit::singleline(&mut self.text).id(Id::new(FIELD)).desired_width(f32::INFINITY);
            let field = ui.add(field);
            let enter = ui.input(|input| input.key_pressed(Key::Enter));
            if enter && (early || field.lost_focus()) && !self.text.is_empty() {
                answer = Some(Answer::Open(at_home(&self.text)));
            } else if ui.input(|input| input.key_pressed(Key::Escape)) {
                answer = Some(Answer::Nothing);
            } else if !field.has_focus() {
                field.request_focus();
            }
            answer = self.list(ui).or(answer.take());
        });
        answer
    }

    /// Takes what is typed before the field does, if it does not yet: a frame may take long.
    fn take_early(&mut self, ui: &Ui) -> bool {
        let early = !ui.memory(|memory| memory.has_focus(Id::new(FIELD)));
        if early {
            ui.input(|input| {
                // Not what was typed before the key that asked.
                let asked = input.events.iter().rposition(|event| {
                    matches!(event, Event::Key { key: Key::O, pressed: true, modifiers, .. } if modifiers.command)
                });
                for event in &input.events[asked.map_or(0, |asked| asked + 1)..] {
                    if let Event::Text(text) = event {
                        self.text.push_str(text);
                    }
                }
            });
        }
        early
    }

    /// What begins as the text does.
    fn list(&mut self, ui: &mut Ui) -> Option<Answer> {
        let (_, begin) = split(&self.text);
        let found = self.there.iter().filter(|name| name.starts_with(begin));
        let mut chosen = None;
        ScrollArea::vertical().max_height(240.0).show(ui, |ui| {
            for name in found {
                if ui.selectable_label(false, name).clicked() {
                    chosen = Some(name.clone());
                }
            }
        });
        let name = chosen?;
        let (folder, _) = split(&self.text);
        self.text = format!("{folder}{name}");
        (!name.ends_with('/')).then(|| Answer::Open(at_home(&self.text)))
    }

    /// Looks into the folder of the text, if it is another than before.
    fn refresh(&mut self) {
        let (folder, _) = split(&self.text);
        let folder = PathBuf::from(if folder.is_empty() { ".".into() } else { at_home(folder) });
        if self.folder.as_ref() != Some(&folder) {
            self.there = there(&folder);
            self.folder = Some(folder);
        }
    }
}

/// A name with the user's own folder in the place of a leading `~`, as a shell has it.
fn at_home(name: &str) -> String {
    let below = name.strip_prefix('~').filter(|below| below.is_empty() || below.starts_with('/'));
    match below.zip(std::env::home_dir()) {
        Some((below, home)) => format!("{}{below}", home.display()),
        None => name.into(),
    }
}

/// The folder with its slash, and the rest.
fn split(text: &str) -> (&str, &str) {
    text.split_at(text.rfind('/').map_or(0, |slash| slash + 1))
}

/// Folders, and what can be opened, by their names.
fn there(folder: &Path) -> Vec<String> {
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
    fn a_tilde_is_the_users_own_folder() {
        let home = std::env::home_dir().unwrap().display().to_string();
        assert_eq!(at_home("~/a.ply"), format!("{home}/a.ply"));
        assert_eq!(
            ["~", "a/~/b", "~b.ply", "scene:sphere"].map(at_home),
            [&home, "a/~/b", "~b.ply", "scene:sphere"]
        );
    }

    #[test]
    fn what_can_be_opened_is_listed_by_name() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("scans")).unwrap();
        for name in ["b.PLY", "a.json", "c.txt", ".hidden.ply", "none"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        assert_eq!(there(folder.path()), ["a.json", "b.PLY", "scans/"]);
        assert!(there(&folder.path().join("not there")).is_empty());
        assert_eq!(split("a/b/c"), ("a/b/", "c"));
        assert_eq!(split("c"), ("", "c"));
    }
}
