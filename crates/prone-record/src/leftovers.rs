//! What a program that is ended at once must not leave behind: hidden files, locks, running children.
//!
//! Destructors remove all of that on every other way out. Where a program ends in the middle, as a
//! second Ctrl-C asks for, no destructor runs: so whatever is to go is written down here for as long
//! as it is there, and [`remove_all`] removes it.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

/// How long [`remove_all`] waits for whoever is making something: a file system may hang.
const PATIENCE: Duration = Duration::from_millis(300);

type Removal = Box<dyn FnOnce() + Send>;

struct List {
    next: u64,
    removals: BTreeMap<u64, Removal>,
}

static LIST: Mutex<List> = Mutex::new(List {
    next: 0,
    removals: BTreeMap::new(),
});

fn list() -> MutexGuard<'static, List> {
    LIST.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Something that is written down until this is dropped.
#[derive(Debug)]
pub struct Leftover(u64);

/// Makes something, and writes down how it is removed, in one step: at no instant it is there and
/// unknown.
///
/// # Errors
/// That of `make`; nothing is written down then.
pub fn make<T, E, R>(
    make: impl FnOnce() -> Result<T, E>,
    removal: impl FnOnce(&T) -> R,
) -> Result<(T, Leftover), E>
where
    R: FnOnce() + Send + 'static,
{
    let mut list = list();
    let made = make()?;
    let id = list.next;
    list.next += 1;
    list.removals.insert(id, Box::new(removal(&made)));
    Ok((made, Leftover(id)))
}

impl Leftover {
    /// Takes the step by which it becomes something that is to stay: it is removed before that step,
    /// or not at all.
    pub fn settle<T>(self, step: impl FnOnce() -> T) -> T {
        let mut list = list();
        list.removals.remove(&self.0);
        step()
    }
}

impl Drop for Leftover {
    fn drop(&mut self) {
        list().removals.remove(&self.0);
    }
}

/// Removes everything that is written down, the newest first. The program is to end right after it:
/// whoever makes something meanwhile waits until then.
pub fn remove_all() {
    let begun = Instant::now();
    let mut list = loop {
        match LIST.try_lock() {
            Ok(list) => break list,
            Err(TryLockError::Poisoned(error)) => break error.into_inner(),
            Err(TryLockError::WouldBlock) if begun.elapsed() > PATIENCE => return,
            Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(1)),
        }
    };
    for (_, removal) in std::mem::take(&mut list.removals).into_iter().rev() {
        removal();
    }
    // Never unlocked again.
    std::mem::forget(list);
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;
    use std::fs;
    use std::sync::Arc;

    #[test]
    fn what_is_settled_or_dropped_is_not_written_down() {
        let made = Arc::new(());
        let written_down = || Arc::strong_count(&made) - 1;
        let make = || {
            let removed = Arc::clone(&made);
            let made = super::make(|| Ok::<_, Infallible>(()), |()| move || drop(removed));
            made.map(|((), leftover)| leftover).unwrap()
        };
        let (first, second) = (make(), make());
        assert_eq!(written_down(), 2);
        drop(first);
        assert_eq!(written_down(), 1);
        assert_eq!(second.settle(|| 7), 7);
        assert_eq!(written_down(), 0);
        let failed = super::make(|| fs::read("/nowhere"), |_| || {});
        assert!(failed.is_err());
    }
}
