//! Many short lists in one flat array.

/// Lists of one kind behind each other.
#[derive(Clone, Debug)]
pub(super) struct Lists<V> {
    places: Places,
    values: Vec<V>,
}

#[derive(Clone, Debug)]
enum Places {
    /// So many lists of one length, in order and without gaps: the rule, which takes no memory per list.
    Even { count: usize, length: usize },
    /// Where each list begins and ends, and how many values no list uses any more: a list that is replaced by one of another
    /// length moves to the end.
    Uneven { spans: Vec<(usize, usize)>, unused: usize },
}

impl<V: Copy> Lists<V> {
    pub(super) fn new() -> Self {
        Self { places: Places::Even { count: 0, length: 0 }, values: Vec::new() }
    }

    pub(super) fn len(&self) -> usize {
        match &self.places {
            Places::Even { count, .. } => *count,
            Places::Uneven { spans, .. } => spans.len(),
        }
    }

    /// All values, those that no list uses any more included.
    pub(super) fn values(&self) -> &[V] {
        &self.values
    }

    /// All values, to be replaced one by one.
    pub(super) fn values_mut(&mut self) -> &mut [V] {
        &mut self.values
    }

    #[inline(always)]
    pub(super) fn get(&self, i: usize) -> &[V] {
        match &self.places {
            Places::Even { length, .. } => &self.values[i * length..(i + 1) * length],
            Places::Uneven { spans, .. } => &self.values[spans[i].0..spans[i].1],
        }
    }

    /// Where list `i` begins; for the number of lists, where the next one will.
    #[inline(always)]
    pub(super) fn start(&self, i: usize) -> usize {
        match &self.places {
            Places::Even { length, .. } => i * length,
            Places::Uneven { spans, .. } => spans.get(i).map_or(self.values.len(), |span| span.0),
        }
    }

    /// The four lists from `i` on, if they are all of `length`.
    #[inline(always)]
    pub(super) fn four_of(&self, length: usize, i: usize) -> Option<[&[V]; 4]> {
        match &self.places {
            Places::Even { length: all, .. } if *all == length => {
                let lists = &self.values[i * length..][..4 * length];
                Some([0, 1, 2, 3].map(|j| &lists[j * length..(j + 1) * length]))
            }
            Places::Uneven { .. } => {
                let lists = [i, i + 1, i + 2, i + 3].map(|i| self.get(i));
                lists.iter().all(|list| list.len() == length).then_some(lists)
            }
            Places::Even { .. } => None,
        }
    }

    /// Appends a list, written by `append` to the end of the values.
    pub(super) fn push_with<R>(&mut self, append: impl FnOnce(&mut Vec<V>) -> R) -> R {
        let start = self.values.len();
        let result = append(&mut self.values);
        let new = self.values.len() - start;
        match &mut self.places {
            Places::Even { count: count @ 0, length } => (*count, *length) = (1, new),
            Places::Even { count, length } if *length == new => *count += 1,
            _ => self.spans().push((start, start + new)),
        }
        result
    }

    pub(super) fn replace(&mut self, i: usize, list: &[V]) {
        let (start, length) = (self.start(i), self.get(i).len());
        if list.len() == length {
            self.values[start..start + length].copy_from_slice(list);
            return;
        }
        let end = self.values.len();
        self.spans()[i] = (end, end + list.len());
        self.values.extend_from_slice(list);
        if let Places::Uneven { unused, .. } = &mut self.places {
            *unused += length;
            if *unused > self.values.len() / 2 {
                self.retain(&vec![true; self.len()]);
            }
        }
    }

    pub(super) fn retain(&mut self, keep: &[bool]) {
        let mut kept = Self::new();
        for i in (0..self.len()).filter(|&i| keep[i]) {
            kept.push_with(|values| values.extend_from_slice(self.get(i)));
        }
        *self = kept;
    }

    /// The places as spans, for lists that are not even any more.
    fn spans(&mut self) -> &mut Vec<(usize, usize)> {
        if let Places::Even { count, length } = self.places {
            let spans = (0..count).map(|i| (i * length, (i + 1) * length)).collect();
            self.places = Places::Uneven { spans, unused: 0 };
        }
        match &mut self.places {
            Places::Uneven { spans, .. } => spans,
            Places::Even { .. } => unreachable!("made uneven above"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_equal(lists: &Lists<u32>, expected: &[Vec<u32>]) {
        assert_eq!(lists.len(), expected.len());
        for (i, list) in expected.iter().enumerate() {
            assert_eq!(lists.get(i), list);
        }
        for length in 0..4 {
            for (i, four) in expected.windows(4).enumerate() {
                let are_of_length = four.iter().all(|list| list.len() == length);
                assert_eq!(lists.four_of(length, i).is_some_and(|lists| four.iter().eq(lists)), are_of_length);
            }
        }
    }

    #[test]
    fn lists_of_any_length_are_kept_whatever_happens_to_them() {
        let mut state = 1_u32;
        let mut number = |most: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % most
        };
        // The first rounds keep to one length.
        for round in 0..60 {
            let (mut lists, mut expected) = (Lists::new(), Vec::<Vec<u32>>::new());
            for _ in 0..80 {
                let length = if round < 20 { 3 } else { number(4) };
                let list: Vec<u32> = (0..length).map(|_| number(1000)).collect();
                match number(8) {
                    0..5 => {
                        lists.push_with(|values| values.extend_from_slice(&list));
                        expected.push(list);
                    }
                    5..7 if !expected.is_empty() => {
                        let i = number(expected.len() as u32) as usize;
                        lists.replace(i, &list);
                        expected[i] = list;
                    }
                    _ => {
                        let keep: Vec<bool> = expected.iter().map(|_| number(5) > 0).collect();
                        lists.retain(&keep);
                        let mut flags = keep.iter();
                        expected.retain(|_| flags.next() == Some(&true));
                    }
                }
                assert_equal(&lists, &expected);
            }
        }
    }
}
