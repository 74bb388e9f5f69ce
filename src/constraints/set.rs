//! All constraints of a model: ids, weights and the batches of every type.

use std::sync::Arc;

use glam::DVec3;

use super::references::References;
use super::{Batch, PAIRS, ProjectPair, REGISTRY, ReferenceId, ReferenceShape, TypeIndex, TypeInfo};
use crate::error::{Error, Result, Status, finite};

/// The number of a constraint: they count up from 0 and are never reused.
pub type ConstraintId = usize;

/// Where a constraint lies.
#[derive(Clone, Copy)]
struct Place {
    type_index: TypeIndex,
    slot: u32,
}

/// The constraints of one type with what the user says of each.
struct Group {
    batch: Box<dyn Batch>,
    ids: Vec<u32>,
    weights: Vec<f64>,
    is_hard: Vec<bool>,
    is_removed: Vec<bool>,
}

/// Constraints of one type that are added in one call.
#[derive(Clone, Copy, Debug)]
pub struct NewConstraints<'a> {
    /// The name of the type.
    pub type_name: &'a str,
    /// The point indices of all constraints behind each other.
    pub indices: &'a [u32],
    /// The number of indices of each constraint; its length is the number of constraints.
    pub counts: &'a [usize],
    /// One weight for all, or one per constraint.
    pub weights: &'a [f64],
    /// The scalar sets behind each other.
    pub scalars: &'a [f64],
    /// The number of scalars of each set. Empty: the defaults. One: a set for all. Else one set per constraint.
    pub scalar_counts: &'a [usize],
}

impl<'a> NewConstraints<'a> {
    /// The weight of constraint `i`.
    fn weight(&self, i: usize) -> f64 {
        if self.weights.len() == 1 { self.weights[0] } else { self.weights[i] }
    }

    /// Indices and scalars of each constraint; the counts were checked.
    fn each(self) -> impl Iterator<Item = (&'a [u32], Option<&'a [f64]>)> {
        let (mut indices, mut scalars) = (self.indices, self.scalars);
        self.counts.iter().enumerate().map(move |(i, &count)| {
            let (own, rest) = indices.split_at(count);
            indices = rest;
            let set = match self.scalar_counts.len() {
                0 => None,
                1 => Some(scalars),
                _ => {
                    let (set, rest) = scalars.split_at(self.scalar_counts[i]);
                    scalars = rest;
                    Some(set)
                }
            };
            (own, set)
        })
    }
}

/// Refuses `counts` that do not add up to `length`; `name` is the list that they divide.
fn check_sum(name: &str, counts: &[usize], length: usize) -> Result<()> {
    let sum = counts.iter().try_fold(0_usize, |sum, &count| sum.checked_add(count));
    if sum == Some(length) {
        return Ok(());
    }
    let asked = sum.map_or("more than there can be".to_owned(), |sum| sum.to_string());
    let reason = format!("the counts add up to {asked}, found {length}");
    Err(Error::new(Status::InvalidArgumentLength, reason).at(name))
}

/// Refuses a list that has neither one entry nor one per constraint.
fn check_one_or_each(name: &str, length: usize, constraint_count: usize) -> Result<()> {
    if length == 1 || length == constraint_count {
        return Ok(());
    }
    let reason = format!("expected 1 or {constraint_count}, found {length}");
    Err(Error::new(Status::InvalidArgumentLength, reason).at(name))
}

/// All constraints of a model.
pub struct ConstraintSet {
    /// By type index.
    groups: Vec<Group>,
    /// By id; `None` once removed.
    places: Vec<Option<Place>>,
    /// The number of slots that are removed but not yet dropped.
    removed_count: usize,
    references: References,
}

impl Default for ConstraintSet {
    fn default() -> Self {
        let group = |new_batch: fn() -> Box<dyn Batch>| Group {
            batch: new_batch(),
            ids: Vec::new(),
            weights: Vec::new(),
            is_hard: Vec::new(),
            is_removed: Vec::new(),
        };
        Self {
            groups: REGISTRY.iter().map(|entry| group(entry.new_batch)).collect(),
            places: Vec::new(),
            removed_count: 0,
            references: References::default(),
        }
    }
}

impl Clone for ConstraintSet {
    fn clone(&self) -> Self {
        let copy = |group: &Group| Group {
            batch: group.batch.clone_box(),
            ids: group.ids.clone(),
            weights: group.weights.clone(),
            is_hard: group.is_hard.clone(),
            is_removed: group.is_removed.clone(),
        };
        Self {
            groups: self.groups.iter().map(copy).collect(),
            places: self.places.clone(),
            removed_count: self.removed_count,
            references: self.references.clone(),
        }
    }
}

impl std::fmt::Debug for ConstraintSet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ConstraintSet").field("id_count", &self.id_count()).finish_non_exhaustive()
    }
}

impl ConstraintSet {
    /// The number of ids given out, removed ones included.
    pub fn id_count(&self) -> usize {
        self.places.len()
    }

    /// True if `id` is a constraint that was not removed.
    pub fn contains(&self, id: ConstraintId) -> bool {
        self.places.get(id).is_some_and(Option::is_some)
    }

    /// The number of references.
    pub fn reference_count(&self) -> usize {
        self.references.len()
    }

    /// Adds a shape for constraints to refer to.
    pub fn add_reference(&mut self, shape: ReferenceShape) -> ReferenceId {
        self.references.push(shape)
    }

    /// Adds constraints of one type, at rest where `points` are now, all or none. Their ids follow each other from the
    /// one returned. An error is placed at `name_of` the id that the constraint would have got.
    ///
    /// # Errors
    /// The type is unknown, a count does not fit, an index is out of range, a weight is negative or not finite, a
    /// scalar is outside its domain or names no reference of the type's kind. Nothing is added then.
    pub fn add(
        &mut self,
        points: &[DVec3],
        new: NewConstraints<'_>,
        name_of: impl Fn(ConstraintId) -> String,
    ) -> Result<ConstraintId> {
        let type_index = match TypeIndex::named(new.type_name) {
            Ok(type_index) => type_index,
            Err(error) => return Err(error.at(name_of(self.places.len()))),
        };
        self.check_new(points.len(), type_index, new, name_of)?;
        let first_id = self.places.len();
        // Where a type has a reference, the default is the first of its kind.
        let first_reference = match REGISTRY[type_index.0 as usize].reference {
            Some(kind) if new.scalar_counts.is_empty() && !new.counts.is_empty() => {
                Some([self.references.first(kind)? as f64])
            }
            _ => None,
        };
        let references = &self.references;
        let group = &mut self.groups[type_index.0 as usize];
        for (i, (indices, scalars)) in new.each().enumerate() {
            let slot = group.batch.len();
            let scalars = scalars.or(first_reference.as_ref().map(<[f64; 1]>::as_slice));
            let reference = named_reference(references, type_index, scalars)?;
            group.batch.push(points, indices, reference);
            if let Some(scalars) = scalars {
                group.batch.set_scalars(slot, scalars, reference);
            }
            group.ids.push(self.places.len() as u32);
            group.weights.push(new.weight(i));
            group.is_hard.push(false);
            group.is_removed.push(false);
            self.places.push(Some(Place { type_index, slot: slot as u32 }));
        }
        Ok(first_id)
    }

    /// Refuses an edit by what `type_name` and `id` alone decide.
    ///
    /// # Errors
    /// In this order: the type cannot be edited (`InvalidConstraintType`), `id` is no constraint of that type
    /// (`UnmatchingConstraintId`).
    pub fn check_editable(&self, type_name: &str, id: ConstraintId) -> Result<()> {
        self.editable_place(type_name, id).map(|_| ())
    }

    /// Replaces the scalars of a constraint. Returns what the edit changed.
    ///
    /// # Errors
    /// In this order: what [`Self::check_editable`] refuses, the number of scalars does not fit
    /// (`InvalidArgumentLength`), a scalar is outside its domain (`InvalidValue`). Nothing changes then.
    pub fn edit(&mut self, type_name: &str, id: ConstraintId, scalars: &[f64]) -> Result<Edited> {
        self.check_edit(type_name, id, scalars)?;
        let place = self.place(id)?;
        let slot = place.slot as usize;
        let reference = named_reference(&self.references, place.type_index, Some(scalars))?;
        let group = &mut self.groups[place.type_index.0 as usize];
        if group.batch.scalars(slot) == scalars {
            return Ok(Edited::Nothing);
        }
        Ok(if group.batch.set_scalars(slot, scalars, reference) { Edited::Rows } else { Edited::Targets })
    }

    /// Refuses what [`ConstraintSet::edit`] would refuse.
    ///
    /// # Errors
    /// As [`ConstraintSet::edit`].
    pub fn check_edit(&self, type_name: &str, id: ConstraintId, scalars: &[f64]) -> Result<()> {
        let place = self.editable_place(type_name, id)?;
        let group = &self.groups[place.type_index.0 as usize];
        check_scalars(place.type_index, group.batch.indices(place.slot as usize).len(), scalars)?;
        named_reference(&self.references, place.type_index, Some(scalars)).map(drop)
    }

    /// Sets the weight of a constraint; returns true if it is another one than before.
    ///
    /// # Errors
    /// The id is no constraint, or the weight is negative or not finite.
    pub fn set_weight(&mut self, id: ConstraintId, weight: f64) -> Result<bool> {
        self.check_weight(id, weight)?;
        let place = self.place(id)?;
        let old = &mut self.groups[place.type_index.0 as usize].weights[place.slot as usize];
        Ok(std::mem::replace(old, weight) != weight)
    }

    /// Refuses what [`ConstraintSet::set_weight`] would refuse.
    ///
    /// # Errors
    /// As [`ConstraintSet::set_weight`].
    pub fn check_weight(&self, id: ConstraintId, weight: f64) -> Result<()> {
        self.place(id)?;
        check_weight(weight)
    }

    /// Makes a constraint hard or soft; returns true if it was the other before.
    ///
    /// # Errors
    /// The id is no constraint, or its rest state is degenerate and it is to become hard: nothing can be demanded of
    /// it.
    pub fn set_hard(&mut self, id: ConstraintId, is_hard: bool) -> Result<bool> {
        self.check_hard(id, is_hard)?;
        let place = self.place(id)?;
        let old = &mut self.groups[place.type_index.0 as usize].is_hard[place.slot as usize];
        Ok(std::mem::replace(old, is_hard) != is_hard)
    }

    /// Refuses what [`ConstraintSet::set_hard`] would refuse.
    ///
    /// # Errors
    /// As [`ConstraintSet::set_hard`].
    pub fn check_hard(&self, id: ConstraintId, is_hard: bool) -> Result<()> {
        let place = self.place(id)?;
        let batch = &self.groups[place.type_index.0 as usize].batch;
        if is_hard && batch.is_degenerate(place.slot as usize) {
            let name = place.type_index.info().name;
            let reason = format!(
                "constraint {id} (\"{name}\") cannot be hard: its points span too little at rest for it to move them"
            );
            return Err(Error::new(Status::InvalidValue, reason));
        }
        Ok(())
    }

    /// Forgets the constraints from `first` on as if they had never been added: those of the last call of
    /// [`Self::add`].
    pub(crate) fn take_back(&mut self, first: ConstraintId) {
        for id in first..self.places.len() {
            if let Some(place) = self.places[id] {
                self.drop_place(id, place);
            }
        }
        self.places.truncate(first);
        self.compact();
    }

    /// The types of soft constraints, in registry order.
    pub(crate) fn soft_types(&self) -> impl Iterator<Item = &'static TypeInfo> + '_ {
        let has_soft = |group: &&Group| group.is_hard.iter().zip(&group.is_removed).any(|(hard, gone)| !hard && !gone);
        self.groups.iter().filter(has_soft).map(|group| group.batch.info())
    }

    /// The number of hard constraints.
    pub fn hard_count(&self) -> usize {
        self.groups.iter().map(|group| group.is_hard.iter().filter(|is_hard| **is_hard).count()).sum()
    }

    /// The hard ones or the soft ones alone. Ids stay.
    pub(crate) fn part(&self, is_hard: bool) -> Self {
        let mut part = self.clone();
        for (id, place) in self.places.iter().enumerate() {
            let Some(place) = place else { continue };
            if self.groups[place.type_index.0 as usize].is_hard[place.slot as usize] != is_hard {
                part.drop_place(id, *place);
            }
        }
        part.compact();
        part
    }

    /// Gives every constraint points of its own, batch after batch and slot after slot; returns their number.
    pub(crate) fn renumber(&mut self) -> usize {
        self.groups.iter_mut().fold(0, |first, group| group.batch.renumber(first)) as usize
    }

    /// The ids of the constraints in the order of batches and slots.
    pub(crate) fn ids_by_slot(&self) -> impl Iterator<Item = ConstraintId> + '_ {
        self.groups.iter().flat_map(|group| group.ids.iter().map(|&id| id as ConstraintId))
    }

    /// Removes a constraint; its id is never given out again.
    ///
    /// # Errors
    /// The id is no constraint.
    pub fn remove(&mut self, id: ConstraintId) -> Result<()> {
        let place = self.place(id)?;
        self.drop_place(id, place);
        Ok(())
    }

    fn drop_place(&mut self, id: ConstraintId, place: Place) {
        let (group, slot) = (&mut self.groups[place.type_index.0 as usize], place.slot as usize);
        group.is_removed[slot] = true;
        group.is_hard[slot] = false;
        group.weights[slot] = 0.0;
        self.places[id] = None;
        self.removed_count += 1;
    }

    /// Drops the slots of removed constraints.
    pub(crate) fn compact(&mut self) {
        if self.removed_count == 0 {
            return;
        }
        for group in self.groups.iter_mut().filter(|group| group.is_removed.contains(&true)) {
            let keep: Vec<bool> = group.is_removed.iter().map(|&is_removed| !is_removed).collect();
            group.batch.retain(&keep);
            let mut flags = keep.iter();
            group.ids.retain(|_| flags.next() == Some(&true));
            let mut flags = keep.iter();
            group.weights.retain(|_| flags.next() == Some(&true));
            let mut flags = keep.iter();
            group.is_hard.retain(|_| flags.next() == Some(&true));
            group.is_removed = vec![false; group.ids.len()];
            for (slot, &id) in group.ids.iter().enumerate() {
                if let Some(place) = &mut self.places[id as usize] {
                    place.slot = slot as u32;
                }
            }
        }
        self.removed_count = 0;
    }

    /// The batches with the weights of their slots (0 for removed ones), in registry order.
    pub(crate) fn batches(&self) -> impl ExactSizeIterator<Item = (&dyn Batch, &[f64])> {
        self.groups.iter().map(|group| (&*group.batch, group.weights.as_slice()))
    }

    /// The batch of the type with this index.
    pub(crate) fn batch(&self, type_index: usize) -> &dyn Batch {
        &*self.groups[type_index].batch
    }

    /// The batches, by the indices of their types, that can be projected together, and how.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = ([usize; 2], ProjectPair)> {
        PAIRS.iter().filter_map(|pair| {
            let indices = 0..self.groups.len();
            let both = indices.clone().flat_map(|a| indices.clone().map(move |b| [a, b]));
            let found = both.into_iter().find(|[a, b]| (pair.is_of)(self.batch(*a), self.batch(*b)));
            found.map(|found| (found, pair.project))
        })
    }

    /// The type, indices, weight and scalars in force of a constraint; `None` if the id is none.
    pub fn get(&self, id: ConstraintId) -> Option<ConstraintView<'_>> {
        let place = (*self.places.get(id)?)?;
        let (group, slot) = (&self.groups[place.type_index.0 as usize], place.slot as usize);
        Some(ConstraintView {
            info: place.type_index.info(),
            indices: group.batch.indices(slot),
            weight: group.weights[slot],
            is_hard: group.is_hard[slot],
            scalars: group.batch.scalars(slot),
            is_degenerate: group.batch.is_degenerate(slot),
        })
    }

    /// The violation of every id at `points`, each in its type's unit; 0 for removed ones. Length [`Self::id_count`].
    pub fn violations(&self, points: &[DVec3]) -> Vec<f64> {
        let violation =
            |place: &Place| self.groups[place.type_index.0 as usize].batch.violation(place.slot as usize, points);
        self.places.iter().map(|place| place.as_ref().map_or(0.0, violation)).collect()
    }

    /// The first constraint that refers to a point at or beyond `point_count`, with that point.
    pub(crate) fn first_beyond(&self, point_count: usize) -> Option<(ConstraintId, u32)> {
        let all = (0..self.places.len()).filter_map(|id| Some((id, self.get(id)?)));
        all.filter_map(|(id, view)| {
            let most = view.indices.iter().copied().max()?;
            (most as usize >= point_count).then_some((id, most))
        })
        .next()
    }

    fn editable_place(&self, type_name: &str, id: ConstraintId) -> Result<Place> {
        let named = TypeIndex::named(type_name)?.info();
        named.check_editable()?;
        let place = self.place(id)?;
        let info = place.type_index.info();
        if named.name != info.name && info.edited_as != Some(named.name) {
            let reason = format!("constraint {id} is of type \"{}\", not \"{type_name}\"", info.name);
            return Err(Error::new(Status::UnmatchingConstraintId, reason).at("constraint id"));
        }
        Ok(place)
    }

    fn place(&self, id: ConstraintId) -> Result<Place> {
        match self.places.get(id) {
            Some(Some(place)) => Ok(*place),
            Some(None) => {
                let reason = format!("constraint {id} was removed");
                Err(Error::new(Status::UnmatchingConstraintId, reason).at("constraint id"))
            }
            None => {
                let reason = format!("{id} is none of the {} ids given out", self.places.len());
                Err(Error::new(Status::UnmatchingConstraintId, reason).at("constraint id"))
            }
        }
    }

    fn check_new(
        &self,
        point_count: usize,
        type_index: TypeIndex,
        new: NewConstraints<'_>,
        name_of: impl Fn(ConstraintId) -> String,
    ) -> Result<()> {
        let info = type_index.info();
        let name_of = |i: usize| name_of(self.places.len() + i);
        if u32::try_from(self.places.len() + new.counts.len()).is_err() {
            return Err(Error::new(Status::TooLarge, "more than 4294967295 constraints"));
        }
        for (i, &count) in new.counts.iter().enumerate() {
            info.check_index_count(count).map_err(|error| error.at(name_of(i)))?;
        }
        check_sum("indices", new.counts, new.indices.len())?;
        check_one_or_each("number of weights", new.weights.len(), new.counts.len())?;
        match new.scalar_counts {
            [] => check_sum("scalars", &[], new.scalars.len())?,
            sets => {
                check_one_or_each("number of scalar sets", sets.len(), new.counts.len())?;
                check_sum("scalars", sets, new.scalars.len())?;
            }
        }
        for (i, (indices, scalars)) in new.each().enumerate() {
            let check = || -> Result<()> {
                for (j, &index) in indices.iter().enumerate() {
                    if index as usize >= point_count {
                        let reason = format!("{index} is out of range for {point_count} points");
                        return Err(Error::new(Status::IndexOutOfRange, reason).at(format!("indices[{j}]")));
                    }
                }
                check_weight(new.weight(i))?;
                if let Some(scalars) = scalars {
                    check_scalars(type_index, indices.len(), scalars)?;
                }
                named_reference(&self.references, type_index, scalars).map(drop)
            };
            check().map_err(|error| error.at(name_of(i)))?;
        }
        Ok(())
    }
}

/// What an edit changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edited {
    /// The scalars were those already in force.
    Nothing,
    /// The projection; the rows and the measure are as before.
    Targets,
    /// The rows or the measure: the system must be factorised again.
    Rows,
}

/// One constraint as it stands.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintView<'a> {
    /// The type.
    pub info: &'static TypeInfo,
    /// The point indices.
    pub indices: &'a [u32],
    /// The user's weight.
    pub weight: f64,
    /// True if it must be met exactly; its weight is then its priority where not everything can be.
    pub is_hard: bool,
    /// The scalars in force.
    pub scalars: &'a [f64],
    /// True if its rest state is degenerate.
    pub is_degenerate: bool,
}

/// The reference that the scalars of a constraint name; by default the first of the kind that the type takes.
fn named_reference<'a>(
    references: &'a References,
    type_index: TypeIndex,
    scalars: Option<&[f64]>,
) -> Result<Option<&'a Arc<ReferenceShape>>> {
    let Some(kind) = REGISTRY[type_index.0 as usize].reference else { return Ok(None) };
    let id = match scalars.and_then(<[f64]>::first) {
        Some(scalar) => *scalar,
        None => references.first(kind)? as f64,
    };
    references.named(kind, id).map(Some)
}

fn check_weight(weight: f64) -> Result<()> {
    if finite("weight", weight)? >= 0.0 {
        return Ok(());
    }
    Err(Error::new(Status::InvalidValue, format!("expected at least 0, found {weight}")).at("weight"))
}

fn check_scalars(type_index: TypeIndex, index_count: usize, scalars: &[f64]) -> Result<()> {
    type_index.info().check_scalar_count(index_count, scalars.len())?;
    for (i, &scalar) in scalars.iter().enumerate() {
        finite(&format!("scalars[{i}]"), scalar)?;
    }
    (REGISTRY[type_index.0 as usize].check_scalars)(scalars).map_err(|error| error.at("scalars"))
}
