using System;
using System.Collections.Generic;

namespace ShapeOp
{
    public sealed partial class Solver
    {
        /// <summary>Adds a constraint at rest where the points are now.</summary>
        /// <param name="type">The name of its type: see <see cref="ConstraintType.All"/>.</param>
        /// <param name="indices">Point indices.</param>
        /// <param name="weight">Finite, at least 0.</param>
        /// <param name="scalars">As its type states them; null: the type's defaults.</param>
        /// <param name="hard">Whether it is to be met exactly; static mode, see <see cref="SetHard"/>.</param>
        /// <returns>Its id. Ids count up from 0 and are never reused.</returns>
        public int Add(
            string type,
            IEnumerable<int> indices,
            double weight = 1,
            IEnumerable<double> scalars = null,
            bool hard = false)
        {
            int[] ids = Flat.Array(indices, nameof(indices));
            double[] set = scalars == null ? null : Flat.Array(scalars, nameof(scalars));
            return AddLists(type, ids, new[] { ids.Length }, 1, new[] { weight }, set, set == null ? 0 : 1, hard)[0];
        }

        /// <summary>
        /// Adds many constraints of one type, all or none, with one weight and one list of scalars for all.
        /// </summary>
        /// <param name="type">The name of their type: see <see cref="ConstraintType.All"/>.</param>
        /// <param name="indices">The point indices of each, such as the faces of a mesh.</param>
        /// <param name="weight">Finite, at least 0.</param>
        /// <param name="scalars">As the type states them; null: the type's defaults.</param>
        /// <param name="hard">Whether they are to be met exactly; static mode, see <see cref="SetHard"/>.</param>
        /// <returns>The id of each.</returns>
        public int[] AddMany(
            string type,
            IEnumerable<IReadOnlyList<int>> indices,
            double weight = 1,
            IEnumerable<double> scalars = null,
            bool hard = false)
        {
            double[] set = scalars == null ? null : Flat.Array(scalars, nameof(scalars));
            var lists = new Lists<int>(indices, nameof(indices));
            return AddLists(
                type, lists.Values, lists.Counts, lists.Counts.Length, new[] { weight }, set, set == null ? 0 : 1,
                hard);
        }

        /// <summary>Adds many constraints of one type, all or none.</summary>
        /// <param name="type">The name of their type: see <see cref="ConstraintType.All"/>.</param>
        /// <param name="indices">The point indices of each, such as the faces of a mesh.</param>
        /// <param name="weights">One for all or one for each, finite, at least 0.</param>
        /// <param name="scalars">
        /// One list for all or one for each, as the type states them; null: the type's defaults.
        /// </param>
        /// <param name="hard">Whether they are to be met exactly; static mode, see <see cref="SetHard"/>.</param>
        /// <returns>The id of each.</returns>
        public int[] AddMany(
            string type,
            IEnumerable<IReadOnlyList<int>> indices,
            IEnumerable<double> weights,
            IEnumerable<IReadOnlyList<double>> scalars = null,
            bool hard = false)
        {
            var lists = new Lists<int>(indices, nameof(indices));
            double[] each = Flat.Array(weights, nameof(weights));
            Lists<double> sets = scalars == null ? null : new Lists<double>(scalars, nameof(scalars));
            sets?.RequireLikeLengths(ConstraintType.Find(type), lists.Counts, nameof(scalars));
            return AddLists(
                type, lists.Values, lists.Counts, lists.Counts.Length, each, sets?.Values, sets?.Counts.Length ?? 0,
                hard);
        }

        int[] AddLists(
            string type, int[] indices, int[] counts, int number, double[] weights, double[] scalars, int setCount,
            bool hard)
        {
            var ids = new int[number];
            byte[] name = Text.ToLibrary(type, nameof(type));
            handle.Check(
                Native.shapeop_addConstraints(
                    Usable, name, indices, indices.Length, counts, counts.Length, weights, weights.Length, scalars,
                    scalars?.Length ?? 0, setCount, hard ? Hard : 0, ids));
            return ids;
        }

        /// <summary>Replaces the scalars of a constraint. The next solve uses them.</summary>
        /// <param name="type">
        /// The type that it was added with; <see cref="ConstraintType.EditedAs"/> names another one that will do.
        /// </param>
        /// <param name="id">Its id.</param>
        /// <param name="scalars">As the type states them.</param>
        public void Edit(string type, int id, params double[] scalars)
        {
            byte[] name = Text.ToLibrary(type, nameof(type));
            double[] set = Flat.Array(scalars, nameof(scalars));
            handle.Check(Native.shapeop_editConstraint(Usable, name, id, set, set.Length));
        }

        /// <summary>Replaces the scalars of many constraints of one type, all or none.</summary>
        /// <param name="type">The type that they were added with.</param>
        /// <param name="ids">Their ids.</param>
        /// <param name="scalars">One list for all or one for each.</param>
        public void EditMany(string type, IEnumerable<int> ids, IEnumerable<IReadOnlyList<double>> scalars)
        {
            byte[] name = Text.ToLibrary(type, nameof(type));
            int[] constraints = Flat.Array(ids, nameof(ids));
            var sets = new Lists<double>(scalars, nameof(scalars));
            sets.RequireLikeLengths(ConstraintType.Find(type), null, nameof(scalars));
            handle.Check(
                Native.shapeop_editConstraints(
                    Usable, name, constraints, constraints.Length, sets.Values, sets.Values.Length, sets.Counts.Length));
        }

        /// <summary>Sets the weight of a constraint: finite, at least 0. The next solve uses it.</summary>
        public void SetWeight(int id, double weight)
        {
            handle.Check(Native.shapeop_setWeight(Usable, id, weight));
        }

        /// <summary>Sets the weights of many constraints, all or none.</summary>
        /// <param name="ids">Their ids.</param>
        /// <param name="weights">One for all or one for each, finite, at least 0.</param>
        public void SetWeights(IEnumerable<int> ids, IEnumerable<double> weights)
        {
            int[] constraints = Flat.Array(ids, nameof(ids));
            double[] each = Flat.Array(weights, nameof(weights));
            handle.Check(Native.shapeop_setWeights(Usable, constraints, constraints.Length, each, each.Length));
        }

        /// <summary>Removes a constraint. Its id is never given out again.</summary>
        public void Remove(int id)
        {
            handle.Check(Native.shapeop_removeConstraint(Usable, id));
        }

        /// <summary>
        /// The number of constraint ids given out, those of removed ones included: the length of
        /// <see cref="Violations"/>.
        /// </summary>
        public int ConstraintCount
        {
            get { return handle.CheckNumber(Native.shapeop_constraintCount(Usable)); }
        }

        /// <summary>True if the id is a constraint, false if it was removed or never given out.</summary>
        public bool IsConstraint(int id)
        {
            return handle.CheckNumber(Native.shapeop_isConstraint(Usable, id)) != 0;
        }

        /// <summary>
        /// True if the rest state of the constraint spans too little to say what it asks for: a zero-length edge, a flat
        /// triangle. It then asks for less or for nothing, as its type's documentation says.
        /// </summary>
        public bool IsDegenerate(int id)
        {
            return handle.CheckNumber(Native.shapeop_isDegenerate(Usable, id)) != 0;
        }

        /// <summary>Adds a force on every point, in dynamic mode an acceleration.</summary>
        /// <returns>Its id. Ids of forces count up from 0 and are never reused.</returns>
        public int AddGravity(double x, double y, double z)
        {
            return handle.CheckNumber(Native.shapeop_addGravityForce(Usable, new[] { x, y, z }));
        }

        /// <summary>Adds a force on one point.</summary>
        /// <returns>Its id. Ids of forces count up from 0 and are never reused.</returns>
        public int AddVertexForce(int point, double x, double y, double z)
        {
            return handle.CheckNumber(Native.shapeop_addVertexForce(Usable, new[] { x, y, z }, point));
        }

        /// <summary>Replaces a vertex force.</summary>
        public void EditVertexForce(int id, int point, double x, double y, double z)
        {
            Native.shapeop_editVertexForce(Usable, id, new[] { x, y, z }, point);
            handle.CheckLast();
        }

        /// <summary>Removes a force. Its id is never given out again.</summary>
        public void RemoveForce(int id)
        {
            handle.Check(Native.shapeop_removeForce(Usable, id));
        }

        /// <summary>The number of force ids given out, those of removed ones included.</summary>
        public int ForceCount
        {
            get { return handle.CheckNumber(Native.shapeop_forceCount(Usable)); }
        }

        /// <summary>True if the id is a force, false if it was removed or never given out.</summary>
        public bool IsForce(int id)
        {
            return handle.CheckNumber(Native.shapeop_isForce(Usable, id)) != 0;
        }
    }
}
