//! Changes of cells, rows and columns of a table.

use crate::chance::Chance;

use super::tokens;

/// One change.
pub(super) fn change(chance: &mut Chance, text: &str) -> String {
    let mut rows: Vec<Vec<String>> = text
        .lines()
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect();
    if rows.is_empty() {
        return ",\n".to_owned();
    }
    let separator = *chance.one(&[",", ",", ",", ",", ",", ";", "\t", ", "]);
    let row = chance.below(rows.len());
    let column = chance.below(rows[row].len());
    let other = chance.below(rows[row].len());
    let cell = rows[row][column].clone();
    match chance.below(12) {
        0 | 1 => rows[row][column] = tokens::number(chance, &cell),
        2 => rows[row][column] = tokens::string(chance, &cell),
        3 => rows[row][column] = format!("\"{cell}\""),
        4 => rows[row][column] = format!("\"{cell}"),
        5 => drop(rows.remove(row)),
        6 => {
            let again = rows[row].clone();
            rows.splice(row..row, std::iter::repeat_n(again, 1 << chance.below(10)));
        }
        7 => drop(rows[row].remove(column)),
        8 => rows[row].insert(column, cell),
        9 => rows[row].swap(column, other),
        10 => {
            // A whole column: gone, or under the name of another one.
            let gone = chance.once_in(2);
            for cells in rows.iter_mut().filter(|cells| column < cells.len()) {
                if gone {
                    cells.remove(column);
                } else if let Some(cell) = cells.get(other).cloned() {
                    cells[column] = cell;
                }
            }
        }
        _ => {
            let other = chance.below(rows.len());
            rows.swap(row, other);
        }
    }
    let mut text = String::new();
    for cells in rows {
        text.push_str(&cells.join(separator));
        text.push('\n');
    }
    text
}
