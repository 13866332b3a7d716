//! What is missing of a table, where, and by what that is known.

use crate::broken_table::Break;
use crate::record_info::Part;

/// Where a table can be used no further.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}, line {line}: {damage}", part.file())]
pub struct Cut {
    /// Which table.
    pub part: Part,
    /// The first line that cannot be used, from 1.
    pub line: usize,
    /// What is wrong there.
    pub damage: Damage,
}

/// What is wrong with a line of a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Damage {
    /// There is no table at all.
    #[error("there is no such file")]
    NoFile,
    /// The line is not whole.
    #[error(transparent)]
    Broken(#[from] Break),
    /// Not a number that a record can have.
    #[error("{column} is {text:?}, which is no value of a record")]
    Value {
        /// Name of the column.
        column: String,
        /// What stands there, its beginning.
        text: String,
    },
    /// A value that no row can have.
    #[error("{column} is {text:?}, and must be {bound}")]
    Outside {
        /// Name of the column.
        column: String,
        /// What stands there, its beginning.
        text: String,
        /// What may stand there.
        bound: String,
    },
    /// A row is missing, or is twice there.
    #[error("{found} s, where the row of {due:.4} s is due")]
    Time {
        /// What stands there, s.
        found: f64,
        /// What follows after the rows before, s.
        due: f64,
    },
    /// Rows of a record without a fixed step must follow one another.
    #[error("{found} s, which does not follow {last} s of the row before")]
    Order {
        /// What stands there, s.
        found: f64,
        /// Time of the row before, s.
        last: f64,
    },
    /// The quaternion of the root is no turn.
    #[error("the root's quaternion has the length {length:.4}")]
    Turn {
        /// Its length.
        length: f64,
    },
    /// The table ends early.
    #[error("the table ends after {found} of {expected} rows")]
    FewRows {
        /// How many there are.
        found: usize,
        /// How many were recorded.
        expected: usize,
    },
    /// The table goes on.
    #[error("a row more than the {expected} that were recorded")]
    ManyRows {
        /// How many were recorded.
        expected: usize,
    },
    /// Contacts are missing.
    #[error("{found} of {expected} contacts at {time_s:.2} s")]
    FewContacts {
        /// How many there are.
        found: usize,
        /// How many were recorded.
        expected: usize,
        /// At which instant, s.
        time_s: f64,
    },
    /// A contact that no row knows of.
    #[error("a contact at {time_s} s more than were recorded")]
    ManyContacts {
        /// At which instant, s.
        time_s: f64,
    },
}
