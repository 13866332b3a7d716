//! The formats that are read from files of strangers.

/// How a text is built, which decides what its mutants look like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Syntax {
    /// MJCF.
    Xml,
    /// Robots, families, gaits, scenes.
    Toml,
    /// Records, results, compiled robots.
    Json,
    /// Rows, contacts, maps.
    Table,
    /// A head and lines with checksums.
    Journal,
}

macro_rules! formats {
    ($($(#[$doc:meta])* $variant:ident = $name:literal, $syntax:ident;)*) => {
        /// A format, by the file that is mutated.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Format {
            $($(#[$doc])* $variant,)*
        }

        impl Format {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant,)*];

            /// Its name in commands, and that of its folder in the corpus.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// How its texts are built.
            pub const fn syntax(self) -> Syntax {
                match self { $(Self::$variant => Syntax::$syntax,)* }
            }
        }
    };
}

formats! {
    /// `robot.xml`: the gate of MJCF, then the engine.
    RobotXml = "robot-xml", Xml;
    /// `robot.toml`.
    RobotToml = "robot-toml", Toml;
    /// `family.toml`.
    Family = "family", Toml;
    /// A gait that is a pull.
    Pull = "pull", Toml;
    /// A gait that is a whole cycle.
    Cycle = "cycle", Toml;
    /// A scene.
    Scene = "scene", Toml;
    /// `robot.compiled.json`.
    CompiledRobot = "compiled-robot", Json;
    /// A torque map.
    TorqueMap = "torque-map", Table;
    /// `rows.csv` of a record.
    Rows = "record-rows", Table;
    /// `contacts.csv` of a record.
    Contacts = "record-contacts", Table;
    /// `run.json` of a record.
    Run = "record-run", Json;
    /// `model.json` of a record.
    Model = "record-model", Json;
    /// `summary.json` of a record, which a report reads.
    Summary = "record-summary", Json;
    /// `result.json` of a search, which a report reads.
    SearchResult = "search-result", Json;
    /// `history.csv` of a search, which a report reads.
    History = "search-history", Table;
    /// The state of a search, from which it is resumed.
    Checkpoint = "checkpoint", Journal;
}

impl Format {
    /// The format of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|format| format.name() == name)
    }
}
