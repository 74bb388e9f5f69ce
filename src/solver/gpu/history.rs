//! The last iterates of accelerated iterations on the card: the twin of `solver/history.rs`, whose products these are. The
//! vectors stay on the card; the processor sees products alone, and answers with the coefficients of a direction.

use bytemuck::{Pod, Zeroable};

use super::card::{Access, Card, GROUP_SUM, MOVES, Run, THREADS};
use super::gather::vector_bytes;
use crate::error::Result;
use crate::solver::history::{Combination, Products};

/// Workgroups that share the sums of a product: enough for every part of a card, few to read back.
const SHARES: usize = 256;

/// Iterates, and what makes and combines them.
pub(super) struct History {
    pub(super) products: Products,
    capacity: usize,
    count: usize,
    push: Vec<Run>,
    product: Vec<Run>,
    shares: wgpu::Buffer,
    /// Of the plain step, then of each pair.
    factors: Vec<wgpu::Buffer>,
    combine: Vec<Run>,
    length: wgpu::Buffer,
    pub(super) trial: Run,
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Counts {
    count: u32,
    first_share: u32,
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Factors {
    count: u32,
    first: u32,
    second: u32,
    keep: f32,
    a: f32,
    b: f32,
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Trial {
    count: u32,
    length: f32,
}

/// What an iterate is made of: points, right-hand side, solution and its scale; and where moves are told.
#[derive(Clone, Copy)]
pub(super) struct Iterate<'a> {
    pub(super) shift: &'a wgpu::Buffer,
    pub(super) sums: &'a wgpu::Buffer,
    pub(super) solution: &'a wgpu::Buffer,
    pub(super) scale: &'a wgpu::Buffer,
    pub(super) moves: &'a wgpu::Buffer,
}

impl History {
    /// Room for `capacity` pairs (at least 1) of `count` points.
    pub(super) fn new(card: &Card, capacity: usize, count: usize, iterate: Iterate<'_>) -> Result<Self> {
        let (uniform, read, write) = (Access::Uniform, Access::Read, Access::Write);
        let accesses = [uniform, read, read, read, read, write, write, write];
        let push = card.kernel("push", &[GROUP_SUM, include_str!("shaders/push.wgsl")], &accesses)?;
        let product = card.kernel(
            "products",
            &[GROUP_SUM, include_str!("shaders/products.wgsl")],
            &[uniform, read, read, write],
        )?;
        let direct =
            card.kernel("direction", &[include_str!("shaders/direction.wgsl"), THREADS], &[uniform, read, write])?;
        let trial = card.kernel(
            "trial",
            &[MOVES, include_str!("shaders/trial.wgsl"), THREADS],
            &[uniform, read, read, write, write],
        )?;
        let room = |name, vectors: usize| card.room(name, vector_bytes(vectors * count));
        let (last, direction) = (room("the last iterate", 4)?, room("the direction", 1)?);
        let shares = card.room("the shares of products", vector_bytes((capacity + 1) * SHARES))?;
        let Iterate { shift, sums, solution, scale, moves } = iterate;
        let factor = || card.uniform(&Factors::zeroed());
        let length = card.uniform(&Trial::zeroed());
        let mut made = Self {
            products: Products::default(),
            capacity,
            count,
            push: Vec::new(),
            product: Vec::new(),
            factors: vec![factor()],
            combine: Vec::new(),
            trial: card.run_of(&trial, &[&length, &last, &direction, shift, moves], count),
            length,
            shares,
        };
        made.combine.push(card.run_of(&direct, &[&made.factors[0], &last, &direction], count));
        // One workgroup for each share, whatever the number of points.
        let threads = SHARES * super::card::GROUP as usize;
        for place in 0..capacity {
            let pair = room("a pair of iterates", 2)?;
            let counts = |share: usize| Counts { count: count as u32, first_share: (share * SHARES) as u32 };
            let (own, of_plain) = (card.uniform(&counts(place)), card.uniform(&counts(capacity)));
            let buffers = [&of_plain, shift, sums, solution, scale, &last, &pair, &made.shares];
            made.push.push(card.run_of(&push, &buffers, threads));
            made.product.push(card.run_of(&product, &[&own, &last, &pair, &made.shares], threads));
            let factors = factor();
            made.combine.push(card.run_of(&direct, &[&factors, &pair, &direction], count));
            made.factors.push(factors);
        }
        made.forget();
        Ok(made)
    }

    /// Pairs at most.
    pub(super) fn capacity(&self) -> usize {
        self.capacity
    }

    /// Forgets all iterates.
    pub(super) fn forget(&mut self) {
        self.products.reset(self.capacity);
    }

    /// Learns the iterate in hand: submits what makes its products; [`Self::read`] then takes them.
    pub(super) fn push(&mut self, card: &Card) {
        self.products.start_iterate();
        // The first iterate makes no pair: what is written in its place is never asked for.
        let newest = self.products.newest_place();
        let products = self.products.places().map(|place| &self.product[place]);
        card.submit([&self.push[newest]].into_iter().chain(products));
    }

    /// What to read for the products, and how many numbers.
    pub(super) fn shares(&self) -> (&wgpu::Buffer, usize) {
        (&self.shares, 4 * (self.capacity + 1) * SHARES)
    }

    /// Takes the products that were read.
    pub(super) fn take(&mut self, shares: &[f32]) {
        let total = |slot: usize, lane: usize| -> f64 {
            let own = &shares[4 * slot * SHARES..4 * (slot + 1) * SHARES];
            own.iter().skip(lane).step_by(4).map(|share| f64::from(*share)).sum()
        };
        let of_place = |place: usize| std::array::from_fn(|lane| total(place, lane));
        self.products.set(total(self.capacity, 0), of_place);
    }

    /// The runs that write the direction that `combination` describes.
    pub(super) fn direct(&self, card: &Card, combination: &Combination) {
        let n = self.count as u32;
        let plain = Factors { count: n, first: n, second: n, keep: 0.0, a: combination.plain as f32, b: 0.0 };
        card.write(&self.factors[0], &[plain]);
        let mut runs = vec![&self.combine[0]];
        for (age, place) in self.products.places().enumerate().take(combination.moves.len()) {
            let (a, b) = (combination.moves[age] as f32, combination.changes[age] as f32);
            let factors = Factors { count: n, first: 0, second: n, keep: 1.0, a, b };
            card.write(&self.factors[place + 1], &[factors]);
            runs.push(&self.combine[place + 1]);
        }
        card.submit(runs);
    }

    /// Sets how far along the direction the trial is.
    pub(super) fn set_length(&self, card: &Card, length: f64) {
        card.write(&self.length, &[Trial { count: self.count as u32, length: length as f32 }]);
    }
}
