//! Arrays of one length.
//!
//! serde fills `[T; N]` from a TOML array and leaves what is over: a third limit or a sixth link
//! would be cut off in silence.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// An array that was given neither fewer nor more than `N` values.
#[derive(Debug)]
pub(crate) struct Exactly<T, const N: usize>(pub(crate) [T; N]);

/// `#[serde(deserialize_with = "exactly")]` for a field that is an array.
pub(crate) fn exactly<'de, D, T, const N: usize>(deserializer: D) -> Result<[T; N], D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    Exactly::deserialize(deserializer).map(|Exactly(values)| values)
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Exactly<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(Values(PhantomData))
    }
}

struct Values<T, const N: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for Values<T, N> {
    type Value = Exactly<T, N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an array of exactly {N} values")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut array: A) -> Result<Self::Value, A::Error> {
        let mut values = Vec::with_capacity(N);
        while values.len() < N
            && let Some(value) = array.next_element()?
        {
            values.push(value);
        }
        let mut given = values.len();
        while array.next_element::<IgnoredAny>()?.is_some() {
            given += 1;
        }
        match <[T; N]>::try_from(values) {
            Ok(values) if given == N => Ok(Exactly(values)),
            _ => Err(A::Error::invalid_length(given, &self)),
        }
    }
}
