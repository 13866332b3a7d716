//! Tables of the page, and how their cells are written.

use maud::{Markup, Render, html};

/// A table with a caption, the heads of its columns, and the cells of each row.
pub fn table(
    caption: impl Render,
    heads: &[&str],
    rows: impl IntoIterator<Item = Markup>,
) -> Markup {
    html! {
        div.scroll { table {
            caption { (caption) }
            thead { tr { @for head in heads { th scope="col" { (head) } } } }
            tbody { @for row in rows { tr { (row) } } }
        } }
    }
}

/// A value, or a dash.
pub fn optional(value: Option<f64>, show: impl Fn(f64) -> String) -> String {
    value.map_or_else(|| "–".to_owned(), show)
}

/// A share in percent.
pub fn percent(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
}
