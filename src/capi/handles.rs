//! Handles: small integers that name a solver, a surface, a design or a snake, or are recognised as naming none.
//!
//! A handle is `generation << 16 | index`: nonzero, below 2^31, so it survives a caller that cuts it to a C `int`. It
//! is read back from the low 32 bits alone, because the upper half of a register that was loaded as an `int` is not
//! defined. The generation of a place is raised whenever its object is deleted; when its generations are used up, the
//! place is never used again. So no handle is ever given out twice, and a deleted one is recognised for good. Free
//! places wait in a queue, which spreads the generations.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

use super::{current, messages::Message};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::surface::SuperCanal;
use crate::geometry::ruled::design::Draft;
use crate::geometry::snakes::draft::Draft as SnakeDraft;
use crate::solver::Solver;

/// A solver. What points to it is no address but a small integer, a handle.
#[cfg(not(shapeop_compat_header))]
#[derive(Debug)]
pub struct ShapeOpSolver {
    _private: [u8; 0],
}

/// Objects at most at one time: what 16 bits can count.
const MOST_PLACES: usize = 1 << 16;

/// The last generation of a place: what the 15 bits can count that keep a handle below 2^31.
const LAST_GENERATION: u16 = 0x7fff;

/// What the low 32 bits of a pointer say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Handle(u32);

impl Handle {
    /// No object's.
    pub(super) const NONE: Self = Self(0);

    pub(super) fn new(op: *mut ShapeOpSolver) -> Self {
        Self(op.addr() as u32)
    }

    pub(super) fn as_op(self) -> *mut ShapeOpSolver {
        std::ptr::without_provenance_mut(self.0 as usize)
    }

    fn index(self) -> usize {
        (self.0 & 0xffff) as usize
    }

    fn generation(self) -> u32 {
        self.0 >> 16
    }
}

/// What the library keeps for a caller.
pub(super) enum Object {
    Solver(Box<Solver>),
    Canal(Box<SuperCanal>),
    Ruled(Box<Draft>),
    Snake(Box<SnakeDraft>),
}

impl Object {
    /// What messages call it.
    fn name(&self) -> &'static str {
        match self {
            Self::Solver(_) => Solver::NAME,
            Self::Canal(_) => SuperCanal::NAME,
            Self::Ruled(_) => Draft::NAME,
            Self::Snake(_) => SnakeDraft::NAME,
        }
    }
}

/// A kind of object.
pub(super) trait Kind: Sized {
    /// What messages call it.
    const NAME: &'static str;
    /// The argument that is its handle.
    const ARGUMENT: &'static str;

    /// The object, if it is of this kind.
    fn of(object: &mut Object) -> Option<&mut Self>;
}

impl Kind for Solver {
    const NAME: &'static str = "solver";
    const ARGUMENT: &'static str = "op";

    fn of(object: &mut Object) -> Option<&mut Self> {
        if let Object::Solver(solver) = object { Some(solver) } else { None }
    }
}

impl Kind for SuperCanal {
    const NAME: &'static str = "surface";
    const ARGUMENT: &'static str = "surface";

    fn of(object: &mut Object) -> Option<&mut Self> {
        if let Object::Canal(surface) = object { Some(surface) } else { None }
    }
}

impl Kind for Draft {
    const NAME: &'static str = "design";
    const ARGUMENT: &'static str = "design";

    fn of(object: &mut Object) -> Option<&mut Self> {
        if let Object::Ruled(draft) = object { Some(draft) } else { None }
    }
}

impl Kind for SnakeDraft {
    const NAME: &'static str = "snake";
    const ARGUMENT: &'static str = "snake";

    fn of(object: &mut Object) -> Option<&mut Self> {
        if let Object::Snake(draft) = object { Some(draft) } else { None }
    }
}

/// What a handle leads to.
pub(super) struct Slot {
    /// [`Kind::NAME`] of what is or was here: kinds are told apart without the lock.
    name: &'static str,
    state: Mutex<State>,
    /// What the last call that got hold of the object left. Locked only to copy it.
    pub(super) message: Mutex<Message>,
    /// Why the last solve with a report ran where it did. Locked only to copy it.
    pub(super) backend_reason: Mutex<String>,
}

/// An object, or why there is none.
pub(super) enum State {
    Alive(Object),
    /// A panic left the object in a state that nobody knows.
    Broken,
    /// Deleted while another call had already found the slot.
    Deleted,
}

impl Slot {
    fn new(object: Object) -> Self {
        let (name, state) = (object.name(), Mutex::new(State::Alive(object)));
        Self { name, state, message: Mutex::default(), backend_reason: Mutex::default() }
    }

    /// The state, if no other call is using it.
    pub(super) fn try_lock<K: Kind>(&self, handle: Handle) -> Result<MutexGuard<'_, State>> {
        match self.state.try_lock() {
            Ok(state) => Ok(state),
            // Calls catch their panics inside the lock, so this does not happen; if it does, `Broken` says why.
            Err(TryLockError::Poisoned(poisoned)) => {
                let mut state = poisoned.into_inner();
                *state = State::Broken;
                Ok(state)
            }
            Err(TryLockError::WouldBlock) => {
                let reason = if current::solver(handle).is_some() {
                    "the solver is busy: from inside its progress callback it can only be read".to_owned()
                } else {
                    format!("the {} is busy: another call is using it", K::NAME)
                };
                Err(Error::new(Status::Busy, reason).at(K::ARGUMENT))
            }
        }
    }
}

impl State {
    /// The object, if it is usable.
    pub(super) fn object<K: Kind>(&mut self, handle: Handle) -> Result<&mut K> {
        match self {
            Self::Alive(object) => K::of(object).ok_or_else(|| none::<K>(handle)),
            Self::Broken => {
                let what = K::NAME;
                let reason =
                    format!("an earlier error inside the library made this {what} unusable; it can only be deleted");
                Err(Error::new(Status::Internal, reason).at(K::ARGUMENT))
            }
            Self::Deleted => Err(none::<K>(handle)),
        }
    }
}

/// Every handle's place.
struct Table {
    places: Vec<Place>,
    free: VecDeque<u16>,
    most_places: usize,
    last_generation: u16,
}

struct Place {
    generation: u16,
    slot: Option<Arc<Slot>>,
}

/// Locked only to look up, insert or remove: never while an object is used.
static TABLE: Mutex<Table> = Mutex::new(Table::new(MOST_PLACES, LAST_GENERATION));

impl Table {
    const fn new(most_places: usize, last_generation: u16) -> Self {
        Self { places: Vec::new(), free: VecDeque::new(), most_places, last_generation }
    }

    fn insert(&mut self, slot: Arc<Slot>) -> Result<Handle> {
        let index = match self.free.pop_front() {
            Some(index) => usize::from(index),
            None if self.places.len() < self.most_places => {
                self.places.push(Place { generation: 1, slot: None });
                self.places.len() - 1
            }
            None => {
                let (count, things) = (self.places.len(), slot.name);
                let reason = format!("{count} {things}s exist or their handles are used up; delete some");
                return Err(Error::new(Status::TooLarge, reason));
            }
        };
        let place = &mut self.places[index];
        place.slot = Some(slot);
        Ok(Handle(u32::from(place.generation) << 16 | index as u32))
    }

    fn find(&self, handle: Handle) -> Option<Arc<Slot>> {
        let place = self.places.get(handle.index()).filter(|place| u32::from(place.generation) == handle.generation());
        place.and_then(|place| place.slot.clone())
    }

    /// Takes the slot out; its handle is stale from now on.
    fn remove(&mut self, handle: Handle) -> Option<Arc<Slot>> {
        self.find(handle)?;
        let place = &mut self.places[handle.index()];
        if place.generation < self.last_generation {
            place.generation += 1;
            self.free.push_back(handle.index() as u16);
        }
        place.slot.take()
    }
}

fn table() -> MutexGuard<'static, Table> {
    // Nothing in this file panics between two changes, so the table is sound even if a lock was poisoned.
    TABLE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The handle of a new object.
pub(super) fn create(object: Object) -> Result<Handle> {
    let slot = Arc::new(Slot::new(object));
    table().insert(slot)
}

/// The place of an object of a kind.
pub(super) fn find<K: Kind>(handle: Handle) -> Result<Arc<Slot>> {
    find_any(handle).filter(|slot| slot.name == K::NAME).ok_or_else(|| none::<K>(handle))
}

/// The place of an object.
pub(super) fn find_any(handle: Handle) -> Option<Arc<Slot>> {
    table().find(handle)
}

/// Deletes an object that no other call is using.
pub(super) fn delete<K: Kind>(handle: Handle) -> Result<()> {
    let slot = find::<K>(handle)?;
    let mut state = slot.try_lock::<K>(handle)?;
    if matches!(*state, State::Deleted) {
        return Err(none::<K>(handle));
    }
    // Whoever found the slot before now and locks it later sees that it is deleted.
    *state = State::Deleted;
    let removed = table().remove(handle);
    drop(removed);
    Ok(())
}

fn none<K: Kind>(handle: Handle) -> Error {
    let what = K::NAME;
    let reason = match handle.0 {
        0 => format!("expected a {what}'s handle, found null"),
        value => format!("expected a {what}'s handle, found {value:#x}, which was deleted or never was one"),
    };
    Error::new(Status::InvalidHandle, reason).at(K::ARGUMENT)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solver() -> Arc<Slot> {
        Arc::new(Slot::new(Object::Solver(Box::default())))
    }

    #[test]
    fn handles_are_small_nonzero_and_never_given_out_twice() {
        let mut table = Table::new(3, 4);
        let mut seen = Vec::new();
        // 3 places of 4 generations each, then no more.
        for _ in 0..12 {
            let handle = table.insert(solver()).unwrap();
            assert!(handle.0 != 0 && handle.0 < 1 << 31);
            assert!(!seen.contains(&handle));
            assert!(table.find(handle).is_some());
            assert!(table.remove(handle).is_some());
            assert!(table.find(handle).is_none());
            assert!(table.remove(handle).is_none());
            seen.push(handle);
        }
        assert_eq!(table.insert(solver()).unwrap_err().status(), Status::TooLarge);
        assert!(seen.iter().all(|handle| table.find(*handle).is_none()));
    }

    #[test]
    fn freed_places_are_reused_in_the_order_they_were_freed() {
        let mut table = Table::new(8, LAST_GENERATION);
        let handles: Vec<_> = (0..3).map(|_| table.insert(solver()).unwrap()).collect();
        for i in [1, 0, 2] {
            table.remove(handles[i]);
        }
        let reused: Vec<_> = (0..3).map(|_| table.insert(solver()).unwrap().index()).collect();
        assert_eq!(reused, [1, 0, 2]);
    }

    #[test]
    fn the_last_handle_of_all_is_below_two_to_the_31() {
        let last = Handle(u32::from(LAST_GENERATION) << 16 | (MOST_PLACES - 1) as u32);
        assert_eq!(last.0, i32::MAX as u32);
        assert_eq!(Handle::new(last.as_op()), last);
    }

    #[test]
    #[cfg(target_pointer_width = "64")]
    fn the_upper_half_of_a_pointer_is_ignored() {
        let op = std::ptr::without_provenance_mut(0xffff_ffff_0001_0002);
        assert_eq!(Handle::new(op), Handle(0x0001_0002));
    }
}
