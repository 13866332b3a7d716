//! A record as a `NumPy` archive: a zip of one `.npy` file per array, not compressed.
//!
//! The format of an array is `NumPy`'s own, version 1.0
//! (<https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html>).

use std::io::Write as _;

use rawzip::{CompressionMethod, ZipArchiveWriter};

use prone::robot::ContactGroup;

use prone_record::recorded::{Recorded, RecordedRow};

/// An array's data begins at a multiple of this, so that it can be mapped into memory.
const ALIGNMENT: usize = 64;

/// Why there is no archive: an entry is refused, or cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("NumPy archive: {0}")]
pub struct ArchiveError(#[from] rawzip::Error);

/// Makes the archive. Arrays over instants begin with their axis; a number that was not recorded is
/// NaN.
pub fn archive(record: &Recorded) -> Result<Vec<u8>, ArchiveError> {
    let (rows, contacts) = (&record.rows, &record.contacts);
    let joints = record.joints.len();
    let per_joint = |values: &dyn Fn(&RecordedRow) -> &[f64]| {
        let values = rows.iter().flat_map(|row| values(row).iter().copied());
        numbers(&[rows.len(), joints], values)
    };
    let speeds = record.joint_speeds().into_iter().flatten();
    let times = rows.iter().map(|row| row.time_s);
    let cycles = rows.iter().map(|row| row.cycle as f64);
    let ground = rows.iter().flat_map(|row| row.ground_n);
    // What was not recorded is NaN.
    let positions = rows.iter().flat_map(|row| match &row.ground_from_root {
        Some(root) => root.origin().metres().to_array(),
        None => [f64::NAN; 3],
    });
    let turns = rows.iter().map(|row| row.ground_from_root);
    let turns = turns.flat_map(|root| match root.map(|root| root.rotation()) {
        Some(q) => [q.w, q.x, q.y, q.z],
        None => [f64::NAN; 4],
    });
    let contact_times = contacts.iter().map(|contact| contact.time_s);
    let bodies = contacts.iter().map(|contact| &record.bodies[contact.body]);
    let places = contacts.iter().map(|contact| contact.at.metres());
    let forces = contacts.iter().map(|contact| contact.force_n);
    let places = places.flat_map(|place| place.to_array());
    let forces = forces.flat_map(|force| force.to_array());
    let (instants, touches) = (rows.len(), contacts.len());
    let arrays = [
        ("time_s", numbers(&[instants], times)),
        ("cycle", numbers(&[instants], cycles)),
        ("joints", texts(record.joints.iter().map(String::as_str))),
        ("command_rad", per_joint(&|row| row.command.as_slice())),
        ("position_rad", per_joint(&|row| row.angles.as_slice())),
        ("velocity_rad_s", numbers(&[instants, joints], speeds)),
        ("effort_nm", per_joint(&|row| &row.motor_torque_nm)),
        ("root_position_m", numbers(&[instants, 3], positions)),
        ("root_quaternion_wxyz", numbers(&[instants, 4], turns)),
        (
            "ground_groups",
            texts(ContactGroup::ALL.iter().map(|group| group.name())),
        ),
        (
            "ground_n",
            numbers(&[instants, ContactGroup::COUNT], ground),
        ),
        ("contact_time_s", numbers(&[touches], contact_times)),
        ("contact_body", texts(bodies.map(|body| body.name.as_str()))),
        (
            "contact_with",
            texts(contacts.iter().map(|contact| contact.with.as_str())),
        ),
        ("contact_position_m", numbers(&[touches, 3], places)),
        ("contact_force_n", numbers(&[touches, 3], forces)),
    ];
    let mut archive = ZipArchiveWriter::new(Vec::new());
    for (name, array) in arrays {
        let name = format!("{name}.npy");
        let file = archive
            .new_file(&name)
            .compression_method(CompressionMethod::STORE);
        let (mut entry, config) = file.start()?;
        let mut writer = config.wrap(&mut entry);
        writer.write_all(&array).map_err(rawzip::Error::from)?;
        let (_, descriptor) = writer.finish()?;
        entry.finish(descriptor)?;
    }
    Ok(archive.finish()?)
}

/// 64-bit floats, the last axis innermost.
fn numbers(shape: &[usize], values: impl Iterator<Item = f64>) -> Vec<u8> {
    let mut file = head("<f8", shape);
    let begin = file.len();
    file.extend(values.flat_map(f64::to_le_bytes));
    let count = (file.len() - begin) / size_of::<f64>();
    assert_eq!(
        count,
        shape.iter().product::<usize>(),
        "an array of shape {shape:?}"
    );
    file
}

/// Texts in `NumPy`'s form: UTF-32, each as long as the longest, filled up with zeros.
fn texts<'a>(values: impl Iterator<Item = &'a str> + Clone) -> Vec<u8> {
    let longest = values.clone().map(|text| text.chars().count()).max();
    // An array of empty texts has length 1, as NumPy makes it.
    let longest = longest.unwrap_or(0).max(1);
    let mut file = head(&format!("<U{longest}"), &[values.clone().count()]);
    for text in values {
        let filled = text.chars().chain(std::iter::repeat('\0')).take(longest);
        file.extend(filled.flat_map(|letter| u32::from(letter).to_le_bytes()));
    }
    file
}

/// Magic, version, length, and a Python dictionary padded with spaces.
fn head(kind: &str, shape: &[usize]) -> Vec<u8> {
    let axes: Vec<String> = shape.iter().map(usize::to_string).collect();
    let axes = axes.join(", ");
    let mut dictionary =
        format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({axes},), }}");
    let before = b"\x93NUMPY".len() + 2 + 2;
    let length = (before + dictionary.len() + 1).next_multiple_of(ALIGNMENT) - before;
    while dictionary.len() + 1 < length {
        dictionary.push(' ');
    }
    dictionary.push('\n');
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    #[expect(clippy::cast_possible_truncation, reason = "some hundred letters")]
    file.extend((length as u16).to_le_bytes());
    file.extend(dictionary.as_bytes());
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_begins_aligned() {
        let file = numbers(&[2, 3], [0.5; 6].into_iter());
        assert_eq!(file.len() % ALIGNMENT, 48 % ALIGNMENT);
        assert_eq!(&file[file.len() - 49..][..1], b"\n");
        let texts = texts(["ab", "c"].into_iter());
        let letters = &texts[texts.len() - 16..];
        assert_eq!(letters, b"a\0\0\0b\0\0\0c\0\0\0\0\0\0\0");
    }
}
