//! The calls that are made, and how they are drawn.

use std::ffi::{CString, c_int};
use std::ptr;

use proptest::prelude::*;
use shapeop::capi::*;

/// Points of a solver at most.
pub(crate) const MOST_POINTS: usize = 12;

/// Which handle a call names.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Op {
    /// One of the sequence's own solvers, deleted ones included.
    Own(usize),
    /// Any number.
    Value(u64),
}

/// The pointer and count of an array argument.
#[derive(Clone, Debug)]
pub(crate) enum Array<T> {
    /// The values and their number.
    Right(Vec<T>),
    /// A null pointer and any count.
    Null(c_int),
    /// A pointer to values and a negative count.
    Negative(Vec<T>, c_int),
}

impl<T> Array<T> {
    pub(crate) fn data(&self) -> *const T {
        match self {
            Self::Right(values) | Self::Negative(values, _) => values.as_ptr(),
            Self::Null(_) => ptr::null(),
        }
    }

    pub(crate) fn count(&self) -> c_int {
        match self {
            Self::Right(values) => values.len() as c_int,
            Self::Null(count) | Self::Negative(_, count) => *count,
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Options {
    pub(crate) struct_size: u32,
    pub(crate) max_iterations: u32,
    pub(crate) tolerance: f64,
    pub(crate) time_budget_seconds: f64,
}

#[derive(Clone, Debug)]
pub(crate) enum Call {
    Create,
    Delete(Op),
    Init(Op),
    InitDynamic(Op, f64, f64, f64),
    Solve(Op, u32),
    SetPoints(Op, Array<f64>),
    GetPoints(Op, bool, c_int),
    SetTimeStep(Op, f64),
    SetDamping(Op, f64),
    SetThreadCount(Op, c_int),
    SetAcceleration(Op, c_int, u32),
    SetLinearSolver(Op, c_int),
    SetBackend(Op, c_int),
    /// Part of a name, bytes of a binding, bytes in all.
    SetBackendOptions(Op, Option<CString>, f64, f64),
    BackendInfo(Op, Option<u32>),
    ReleaseBackend,
    AddConstraint(Op, Option<CString>, Array<c_int>, f64),
    /// Type, ids, counts, weights, scalars, number of sets, flags, whether ids are wanted.
    AddConstraints(Op, Option<CString>, Array<c_int>, Array<c_int>, Array<f64>, Array<f64>, c_int, u32, bool),
    EditConstraint(Op, Option<CString>, c_int, Array<f64>),
    /// Of the constraints that the solver was given, this one modulo their number, with as many scalars as it takes.
    EditOwn(Op, usize, Vec<f64>),
    /// Type, ids, scalars, number of sets.
    EditConstraints(Op, Option<CString>, Array<c_int>, Array<f64>, c_int),
    SetWeight(Op, c_int, f64),
    SetWeights(Op, Array<c_int>, Array<f64>),
    /// A JSON text, whether the options are wanted.
    SetProblem(Op, Option<CString>, bool),
    RemoveConstraint(Op, c_int),
    IsConstraint(Op, c_int),
    IsDegenerate(Op, c_int),
    AddGravity(Op, Option<[f64; 3]>),
    AddVertexForce(Op, Option<[f64; 3]>, c_int),
    EditVertexForce(Op, c_int, Option<[f64; 3]>, c_int),
    /// Indices, counts, pressure.
    AddPressure(Op, Array<c_int>, Array<c_int>, f64),
    /// Indices, counts, magnitude.
    AddNormalForce(Op, Array<c_int>, Array<c_int>, f64),
    EditForceMagnitude(Op, c_int, f64),
    RemoveForce(Op, c_int),
    AddPolyline(Op, Array<f64>, c_int),
    /// Coordinates, triangles.
    AddMesh(Op, Array<f64>, Array<c_int>),
    SetHard(Op, c_int, c_int),
    SetHandle(Op, c_int, Option<[f64; 3]>),
    ReleaseHandle(Op, c_int),
    /// Handle, closeness and fairness weight, tolerance.
    SetObjective(Op, [f64; 4]),
    /// Kind, indices, counts.
    SetFairness(Op, c_int, Array<c_int>, Array<c_int>),
    Sensitivities(Op, bool),
    Exploration(Op, Option<u32>),
    SolveUntil(Op, Option<Options>, Option<u32>, Option<u32>),
    Energy(Op, bool),
    Violations(Op, bool, c_int),
    ConstraintType(c_int, Option<u32>),
    ConstraintScalar(c_int, c_int, Option<u32>),
    ErrorText(c_int),
}

fn op() -> impl Strategy<Value = Op> {
    prop_oneof![
        20 => (0_usize..4).prop_map(Op::Own),
        1 => prop_oneof![Just(0), Just(1), Just(u64::MAX), any::<u64>(), any::<u32>().prop_map(u64::from)]
            .prop_map(Op::Value),
    ]
}

/// Mostly reasonable numbers, and every kind that is not.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        30 => -3.0..3.0_f64,
        10 => 0.0..2.0_f64,
        5 => prop::sample::select(vec![0.0, -0.0, 1.0, 0.5, 2.0]),
        2 => -1e9..1e9_f64,
        1 => prop::sample::select(vec![
            f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, 1e-9, 1e9,
            1e-160, 1e100, 1e154, -1e155, 1e200, 1e300, -1e308,
        ]),
        1 => any::<f64>(),
    ]
}

fn integer() -> impl Strategy<Value = c_int> {
    prop_oneof![
        20 => 0..12_i32,
        2 => prop::sample::select(vec![-1, i32::MIN, i32::MAX, 1 << 16, 1 << 30]),
        1 => any::<i32>(),
    ]
}

fn array<T: Clone + std::fmt::Debug + 'static>(
    value: impl Strategy<Value = T> + 'static,
    lengths: impl Into<prop::collection::SizeRange>,
) -> impl Strategy<Value = Array<T>> {
    let values = prop::collection::vec(value, lengths.into()).boxed();
    prop_oneof![
        30 => values.clone().prop_map(Array::Right),
        1 => integer().prop_map(Array::Null),
        1 => (values, i32::MIN..0).prop_map(|(values, count)| Array::Negative(values, count)),
    ]
}

fn type_name() -> impl Strategy<Value = Option<CString>> {
    let names: Vec<CString> = shapeop::constraints::types().map(|info| CString::new(info.name).unwrap()).collect();
    prop_oneof![
        30 => prop::sample::select(names).prop_map(Some),
        1 => prop::collection::vec(1..=255_u8, 0..20).prop_map(|bytes| Some(CString::new(bytes).unwrap())),
        1 => Just(None),
    ]
}

fn force() -> impl Strategy<Value = Option<[f64; 3]>> {
    prop_oneof![20 => [number(), number(), number()].prop_map(Some), 1 => Just(None)]
}

/// Points of which most are reasonable; every other set is without a number that would be refused.
fn points() -> impl Strategy<Value = Array<f64>> {
    let flat = (1..=MOST_POINTS, prop::collection::vec(-2.0..2.0_f64, 3 * MOST_POINTS));
    prop_oneof![
        3 => flat.prop_map(|(count, values)| Array::Right(values[..3 * count].to_vec())),
        1 => array(number(), 0..=3 * MOST_POINTS),
        1 => (1..=MOST_POINTS, number(), number())
            .prop_map(|(count, at, step)| Array::Right((0..3 * count).map(|i| at + step * (i / 3) as f64).collect())),
    ]
}

/// A type with as many indices as it takes.
fn fitting() -> impl Strategy<Value = (Option<CString>, Array<c_int>)> {
    let types: Vec<_> = shapeop::constraints::types().collect();
    (prop::sample::select(types), 0..3_usize, prop::collection::vec(0..MOST_POINTS as c_int, 8)).prop_map(
        |(info, more, indices)| {
            let more = if info.rows == shapeop::constraints::Rows::Pairs { 2 * more } else { more };
            let count = (info.least_indices + more).min(info.greatest_indices.unwrap_or(usize::MAX));
            (Some(CString::new(info.name).unwrap()), Array::Right(indices[..count].to_vec()))
        },
    )
}

/// Scalars of which most are in the domain of most types.
fn scalars() -> impl Strategy<Value = Vec<f64>> {
    let rising = (0.1..1.5_f64, 0.0..1.0_f64, 0.0..1.0_f64).prop_map(|(a, b, c)| [a, b, b + c].repeat(8));
    prop_oneof![
        3 => rising,
        2 => prop::collection::vec(-2.0..2.0_f64, 24),
        1 => prop::collection::vec(number(), 24),
    ]
}

/// Index lists of any length.
fn indices() -> impl Strategy<Value = Array<c_int>> {
    prop_oneof![6 => array(0..MOST_POINTS as c_int, 0..7), 1 => array(integer(), 0..7)]
}

/// Faces of which most are triangles or quads of a solver's points.
fn faces() -> impl Strategy<Value = (Array<c_int>, Array<c_int>)> {
    let right = (3..5_i32, 1..4_usize, prop::collection::vec(0..MOST_POINTS as c_int, 12)).prop_map(
        |(corners, faces, indices)| {
            (Array::Right(indices[..corners as usize * faces].to_vec()), Array::Right(vec![corners]))
        },
    );
    prop_oneof![4 => right, 1 => (indices(), array(integer(), 0..4))]
}

/// Whole triples only, as the count of an array argument counts points or triangles.
fn triples<T: Clone + std::fmt::Debug>(array: Array<T>) -> Array<T> {
    match array {
        Array::Right(mut values) => {
            values.truncate(values.len() / 3 * 3);
            Array::Right(values)
        }
        other => other,
    }
}

fn struct_size(right: usize) -> impl Strategy<Value = u32> {
    prop_oneof![8 => Just(right as u32), 1 => 0..=right as u32, 1 => any::<u32>(), 1 => right as u32..4100]
}

fn options() -> impl Strategy<Value = Options> {
    (struct_size(size_of::<shapeop_solve_options>()), 0..30_u32, number(), number()).prop_map(
        |(struct_size, max_iterations, tolerance, time_budget_seconds)| Options {
            struct_size,
            max_iterations,
            tolerance,
            time_budget_seconds,
        },
    )
}

/// Problems of which most are right, with pieces of their text exchanged.
fn json() -> impl Strategy<Value = Option<CString>> {
    let pieces = prop::sample::select(vec!["", "{", "]", "null", "-1", "1e999", "9", "\"Plane\"", "\"x\"", "dynamic"]);
    let right = (number(), 0..5_u32, any::<bool>())
        .prop_map(|(z, index, is_dynamic)| {
            let mode = if is_dynamic { "dynamic" } else { "static" };
            format!(
                "{{\"version\": 1, \"mode\": \"{mode}\", \"points\": [[0, 0, {z}], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]], \
             \"constraints\": [{{\"type\": \"Plane\", \"indices\": [0, 1, 2, {index}], \"weight\": 1}}]}}"
            )
        })
        .boxed();
    let broken =
        (right.clone(), any::<prop::sample::Index>(), 0..12_usize, pieces).prop_map(|(text, at, length, piece)| {
            let start = at.index(text.len());
            let end = (start + length).min(text.len());
            format!("{}{piece}{}", &text[..start], &text[end..])
        });
    let text = prop_oneof![3 => right, 2 => broken];
    prop_oneof![20 => text.prop_map(|text| CString::new(text).ok()), 1 => Just(None)]
}

pub(crate) fn call() -> impl Strategy<Value = Call> {
    let report = struct_size(size_of::<shapeop_solve_report>());
    let named_type = struct_size(size_of::<shapeop_constraint_type>());
    let scalar = struct_size(size_of::<shapeop_constraint_scalar>());
    let changes = prop_oneof![
        1 => Just(Call::Create),
        1 => op().prop_map(Call::Delete),
        8 => (op(), points()).prop_map(|(o, p)| Call::SetPoints(o, p)),
        1 => (op(), number()).prop_map(|(o, x)| Call::SetTimeStep(o, x)),
        1 => (op(), number()).prop_map(|(o, x)| Call::SetDamping(o, x)),
        1 => (op(), prop_oneof![0..3, integer().prop_filter("few threads", |n| !(3..=1024).contains(n))])
            .prop_map(|(o, n)| Call::SetThreadCount(o, n)),
        2 => (op(), prop_oneof![9 => 0..4, 1 => integer()], prop_oneof![9 => 0..10_u32, 1 => any::<u32>()])
            .prop_map(|(o, kind, memory)| Call::SetAcceleration(o, kind, memory)),
        2 => (op(), prop_oneof![3 => 0..3, 1 => integer()]).prop_map(|(o, n)| Call::SetLinearSolver(o, n)),
        2 => (op(), prop_oneof![3 => 0..3, 1 => integer()]).prop_map(|(o, n)| Call::SetBackend(o, n)),
        1 => (op(), type_name(), prop_oneof![2 => (0..99_u32).prop_map(f64::from), 1 => number()], number())
            .prop_map(|(o, t, b, m)| Call::SetBackendOptions(o, t, b, m)),
        14 => (op(), fitting(), 0.0..10.0_f64).prop_map(|(o, (t, i), w)| Call::AddConstraint(o, t, i, w)),
        8 => (op(), 0..99_usize, scalars()).prop_map(|(o, pick, s)| Call::EditOwn(o, pick, s)),
        4 => (op(), type_name(), indices(), number()).prop_map(|(o, t, i, w)| Call::AddConstraint(o, t, i, w)),
        6 => ((op(), type_name(), indices(), array(integer(), 0..4)), array(number(), 0..4), array(number(), 0..9),
              integer(), prop_oneof![9 => Just(0), 1 => any::<u32>()], any::<bool>())
            .prop_map(|((o, t, i, c), w, s, n, f, wants)| Call::AddConstraints(o, t, i, c, w, s, n, f, wants)),
        4 => (op(), type_name(), integer(), array(number(), 0..13))
            .prop_map(|(o, t, id, s)| Call::EditConstraint(o, t, id, s)),
        4 => (op(), type_name(), array(integer(), 0..4), array(number(), 0..13), 0..5_i32)
            .prop_map(|(o, t, i, s, n)| Call::EditConstraints(o, t, i, s, n)),
        3 => (op(), integer(), number()).prop_map(|(o, id, w)| Call::SetWeight(o, id, w)),
        2 => (op(), array(integer(), 0..4), array(number(), 0..4)).prop_map(|(o, i, w)| Call::SetWeights(o, i, w)),
        2 => (op(), json(), any::<bool>()).prop_map(|(o, j, wants)| Call::SetProblem(o, j, wants)),
        3 => (op(), integer()).prop_map(|(o, id)| Call::RemoveConstraint(o, id)),
        1 => (op(), force()).prop_map(|(o, f)| Call::AddGravity(o, f)),
        2 => (op(), force(), integer()).prop_map(|(o, f, id)| Call::AddVertexForce(o, f, id)),
        2 => (op(), integer(), force(), integer()).prop_map(|(o, f_id, f, id)| Call::EditVertexForce(o, f_id, f, id)),
        2 => (op(), integer()).prop_map(|(o, id)| Call::RemoveForce(o, id)),
        3 => (op(), faces(), number()).prop_map(|(o, (i, c), x)| Call::AddPressure(o, i, c, x)),
        3 => (op(), faces(), number()).prop_map(|(o, (i, c), x)| Call::AddNormalForce(o, i, c, x)),
        2 => (op(), integer(), number()).prop_map(|(o, id, x)| Call::EditForceMagnitude(o, id, x)),
        3 => (op(), points(), prop_oneof![9 => 0..2, 1 => integer()])
            .prop_map(|(o, p, closed)| Call::AddPolyline(o, triples(p), closed)),
        3 => (op(), points(), prop_oneof![5 => array(0..3_i32, 3..20), 1 => array(integer(), 0..20)])
            .prop_map(|(o, p, t)| Call::AddMesh(o, triples(p), triples(t))),
        3 => (op(), integer(), prop_oneof![9 => 0..2, 1 => integer()]).prop_map(|(o, id, is)| Call::SetHard(o, id, is)),
        2 => (op(), integer(), force()).prop_map(|(o, id, target)| Call::SetHandle(o, id, target)),
        1 => (op(), integer()).prop_map(|(o, id)| Call::ReleaseHandle(o, id)),
        1 => (op(), [0.1..99.0_f64, 0.1..9.0_f64, 0.0..9.0_f64, 1e-13..1e-3_f64]).prop_map(|(o, w)| Call::SetObjective(o, w)),
        1 => (op(), [number(), number(), number(), number()]).prop_map(|(o, w)| Call::SetObjective(o, w)),
        1 => (op(), prop_oneof![9 => 0..3, 1 => integer()], faces()).prop_map(|(o, k, (i, c))| Call::SetFairness(o, k, i, c)),
    ];
    let solves = prop_oneof![
        4 => op().prop_map(Call::Init),
        3 => (op(), number(), number(), number()).prop_map(|(o, m, d, t)| Call::InitDynamic(o, m, d, t)),
        8 => (op(), 0..8_u32).prop_map(|(o, n)| Call::Solve(o, n)),
        4 => (op(), prop::option::of(options()), prop::option::of(0..10_u32), prop::option::of(report))
            .prop_map(|(o, s, c, r)| Call::SolveUntil(o, s, c, r)),
    ];
    let reads = prop_oneof![
        2 => (op(), any::<bool>(), integer()).prop_map(|(o, null, n)| Call::GetPoints(o, null, n)),
        1 => (op(), integer()).prop_map(|(o, id)| Call::IsConstraint(o, id)),
        1 => (op(), integer()).prop_map(|(o, id)| Call::IsDegenerate(o, id)),
        2 => (op(), any::<bool>()).prop_map(|(o, null)| Call::Energy(o, null)),
        2 => (op(), any::<bool>(), integer()).prop_map(|(o, null, n)| Call::Violations(o, null, n)),
        1 => (op(), any::<bool>()).prop_map(|(o, null)| Call::Sensitivities(o, null)),
        1 => (op(), prop::option::of(struct_size(size_of::<shapeop_backend_info>())))
            .prop_map(|(o, s)| Call::BackendInfo(o, s)),
        1 => Just(Call::ReleaseBackend),
        1 => (op(), prop::option::of(struct_size(size_of::<shapeop_exploration>())))
            .prop_map(|(o, s)| Call::Exploration(o, s)),
        1 => (integer(), prop::option::of(named_type)).prop_map(|(i, s)| Call::ConstraintType(i, s)),
        1 => (integer(), integer(), prop::option::of(scalar)).prop_map(|(i, j, s)| Call::ConstraintScalar(i, j, s)),
        1 => integer().prop_map(Call::ErrorText),
    ];
    prop_oneof![5 => changes, 3 => solves, 1 => reads]
}
