//! The papers' models, which are not part of surfel: a folder may hold some of them.

use super::quotation::Paper::{self, Botsch2003, Marroquim2008, Pajarola2004, Ren2002};
use crate::bench::subject::Subject;
use crate::error::{Error, Result};
use crate::progress::Progress;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// A model of a paper.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// The paper.
    pub paper: Paper,
    /// Name there.
    pub name: &'static str,
    /// Names of files that are accepted as it, in lower case.
    pub files: &'static [&'static str],
    /// Where it is from.
    pub origin: Origin,
}

/// Where a model is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The Stanford 3D Scanning Repository.
    Stanford,
    /// The Digital Michelangelo Project, by licence.
    Michelangelo,
    /// The examples of the program PointShop3D.
    PointShop,
    /// Cyberware's examples.
    Cyberware,
    /// Unknown: the paper names no source, and it was never published under this name.
    Unknown,
}

const fn model(paper: Paper, name: &'static str, files: &'static [&'static str], origin: Origin) -> Model {
    Model { paper, name, files, origin }
}

/// All models.
pub const ALL: [Model; 21] = [
    model(Ren2002, "Salamander", &["salamander.ply"], Origin::Unknown),
    model(Ren2002, "Chameleon", &["chameleon.ply"], Origin::PointShop),
    model(Ren2002, "Wasp", &["wasp.ply"], Origin::Unknown),
    model(Ren2002, "Fiesta", &["fiesta.ply"], Origin::Unknown),
    model(Botsch2003, "Charlemagne", &["charlemagne.ply"], Origin::Unknown),
    model(Botsch2003, "St. Matthew", &["st_matthew.ply", "matthew.ply"], Origin::Michelangelo),
    model(Botsch2003, "David Head", &["david_head.ply"], Origin::Michelangelo),
    model(Botsch2003, "David", &["david.ply"], Origin::Michelangelo),
    model(Botsch2003, "Max", &["max.ply", "max_planck.ply"], Origin::Unknown),
    model(Botsch2003, "Male", &["male.ply"], Origin::PointShop),
    model(Botsch2003, "Balljoint", &["balljoint.ply"], Origin::PointShop),
    model(Botsch2003, "Chameleon", &["chameleon.ply"], Origin::PointShop),
    model(Pajarola2004, "David", &["david_head.ply"], Origin::Michelangelo),
    model(Pajarola2004, "Female", &["female.ply"], Origin::Cyberware),
    model(Pajarola2004, "Balljoint", &["balljoint.ply"], Origin::Cyberware),
    model(Pajarola2004, "Dragon", &["dragon_vrip.ply"], Origin::Stanford),
    model(Marroquim2008, "Armadillo", &["armadillo.ply"], Origin::Stanford),
    model(Marroquim2008, "Dragon", &["dragon_vrip.ply"], Origin::Stanford),
    model(Marroquim2008, "Happy Buddha", &["happy_vrip.ply"], Origin::Stanford),
    model(Marroquim2008, "Asian Dragon", &["xyzrgb_dragon.ply"], Origin::Stanford),
    model(Marroquim2008, "Thai Statue", &["xyzrgb_statuette.ply"], Origin::Stanford),
];

impl Origin {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stanford => "Stanford 3D Scanning Repository",
            Self::Michelangelo => "Digital Michelangelo Project, by licence",
            Self::PointShop => "examples of PointShop3D",
            Self::Cyberware => "examples of Cyberware",
            Self::Unknown => "not public: the paper names no source",
        }
    }
}

impl Model {
    /// A paper's model of a name.
    pub fn named(paper: Paper, name: &str) -> Option<&'static Self> {
        ALL.iter().find(|model| model.paper == paper && model.name == name)
    }

    /// Whether a scene or file is the model.
    pub fn is(&self, scene: &str) -> bool {
        let name = Path::new(scene).file_name().map(|name| name.to_string_lossy().to_lowercase());
        name.is_some_and(|name| self.files.contains(&name.as_str()))
    }
}

/// A model with its points.
#[derive(Clone)]
pub struct Given {
    /// The model.
    pub model: &'static Model,
    /// Its points.
    pub subject: Rc<Subject>,
}

/// The models that are given.
#[derive(Clone, Default)]
pub struct Models(Vec<Given>);

impl Models {
    /// The models in a folder, by the names of the files.
    ///
    /// # Errors
    /// [`Error::Io`] and [`Error::Input`] if the folder or a file cannot be read; [`Error::Input`] if no file has the name of a model.
    pub fn open(folder: &Path, progress: &dyn Progress) -> Result<Self> {
        let entries = std::fs::read_dir(folder).map_err(Error::io(folder, "cannot read the folder"))?;
        let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort();
        let mut all = Vec::new();
        for path in paths {
            let name = path.to_string_lossy().into_owned();
            let models: Vec<_> = ALL.iter().filter(|model| model.is(&name)).collect();
            if !models.is_empty() {
                // Papers share models.
                let subject = Rc::new(Subject::scan(&path, None, progress)?);
                all.extend(models.into_iter().map(|model| Given { model, subject: subject.clone() }));
            }
        }
        if all.is_empty() {
            let mut names: Vec<_> = ALL.iter().flat_map(|model| model.files).copied().collect();
            names.sort_unstable();
            names.dedup();
            let cause = format!("no model of the papers: name files as one of {}", names.join(", "));
            return Err(Error::input(folder.display().to_string(), cause));
        }
        Ok(Self(all))
    }

    /// Those of a paper.
    pub fn of(&self, paper: Paper) -> impl Iterator<Item = &Given> {
        self.0.iter().filter(move |given| given.model.paper == paper)
    }

    /// A paper's model of a name.
    pub fn named(&self, paper: Paper, name: &str) -> Option<&Given> {
        self.of(paper).find(|given| given.model.name == name)
    }

    /// The points of all.
    pub fn subjects(&self) -> impl Iterator<Item = Rc<Subject>> {
        self.0.iter().map(|given| given.subject.clone())
    }
}
