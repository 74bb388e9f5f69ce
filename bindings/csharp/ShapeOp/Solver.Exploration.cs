using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.InteropServices;

namespace ShapeOp
{
    // Hard constraints are met exactly, handles are dragged, and everything else changes as little and as fairly as that
    // allows. Static mode.
    public sealed partial class Solver
    {
        /// <summary>SHAPEOP_HARD of the C header, a flag of shapeop_addConstraints.</summary>
        const uint Hard = 1;

        /// <summary>
        /// Makes a constraint hard, to be met exactly, or soft. The weight of a hard one is its priority where not
        /// everything can be met. Solving goes on from where it is.
        /// </summary>
        public void SetHard(int id, bool hard = true)
        {
            handle.Check(Native.shapeop_setHard(Usable, id, hard ? 1 : 0));
        }

        /// <summary>True if the id is a hard constraint, false if it is soft or none.</summary>
        public bool IsHard(int id)
        {
            return handle.CheckNumber(Native.shapeop_isHard(Usable, id)) != 0;
        }

        /// <summary>Makes a point a handle, drawn to a target, or moves its target.</summary>
        public void SetHandle(int point, double x, double y, double z)
        {
            handle.Check(Native.shapeop_setHandle(Usable, point, new[] { x, y, z }));
        }

        /// <summary>Lets a handle go: the point is drawn to where it was at initialisation, as the others are.</summary>
        public void ReleaseHandle(int point)
        {
            handle.Check(Native.shapeop_releaseHandle(Usable, point));
        }

        /// <summary>Sets the weights of what is minimised while hard constraints are met; the fairness stays.</summary>
        public void SetObjective(Objective objective)
        {
            if (objective == null) throw Refusal.Null(nameof(objective));
            Native.shapeop_objective native = objective.ToLibrary();
            handle.Check(Native.shapeop_setObjective(Usable, ref native));
        }

        /// <summary>Sets what the fairness term measures.</summary>
        /// <param name="kind">The kind of differences.</param>
        /// <param name="lists">
        /// Point indices: for <see cref="Fairness.Laplacian"/> of faces or edges, otherwise of polylines.
        /// </param>
        public void SetFairness(Fairness kind, IEnumerable<IReadOnlyList<int>> lists)
        {
            var all = new Lists<int>(lists, nameof(lists));
            handle.Check(
                Native.shapeop_setFairness(
                    Usable, (int)kind, all.Values, all.Values.Length, all.Counts, all.Counts.Length));
        }

        /// <summary>What the last exploration found.</summary>
        /// <exception cref="ShapeOpException">There was none.</exception>
        public Exploration Exploration
        {
            get
            {
                var found = new Native.shapeop_exploration
                {
                    struct_size = (uint)Marshal.SizeOf<Native.shapeop_exploration>(),
                };
                handle.Check(Native.shapeop_getExploration(Usable, ref found));
                return new Exploration(found);
            }
        }

        /// <summary>
        /// The ids of the hard constraints in the contradiction that the last exploration found; empty if there is none.
        /// Without them the others can be met.
        /// </summary>
        public int[] Conflicts
        {
            get
            {
                var ids = new int[handle.CheckNumber(Native.shapeop_getConflicts(Usable, null, 0))];
                handle.CheckNumber(Native.shapeop_getConflicts(Usable, ids, ids.Length));
                return ids;
            }
        }

        /// <summary>How the solution answers a change of each weight.</summary>
        /// <exception cref="ShapeOpException">The last solve did not end in a solution.</exception>
        public Sensitivities GetSensitivities()
        {
            int count = handle.CheckNumber(Native.shapeop_weightClassCount(Usable));
            int pointCount = PointCount;
            var points = new double[3 * count * pointCount];
            var squares = new double[count * count];
            handle.Check(Native.shapeop_getSensitivities(Usable, points, pointCount, squares, count));
            string[] names = Enumerable.Range(0, count)
                .Select(index => Text.FromLibrary(Native.shapeop_weightClassName(Usable, index)))
                .ToArray();
            return new Sensitivities(names, points, squares);
        }

        /// <summary>
        /// Adds a polyline for "OnCurve" constraints to refer to: its id is their scalar. Its points are none of
        /// the solver.
        /// </summary>
        /// <param name="points"><c>x0 y0 z0 x1 ...</c>, at least 2 points.</param>
        /// <param name="closed">Whether a segment leads from the last point back to the first.</param>
        /// <returns>Its id.</returns>
        public int AddReferencePolyline(double[] points, bool closed = false)
        {
            int count = Flat.PointCount(points, nameof(points));
            return handle.CheckNumber(Native.shapeop_addReferencePolyline(Usable, points, count, closed ? 1 : 0));
        }

        /// <summary>
        /// Adds a triangle mesh for "OnMesh" constraints to refer to: its id is their scalar. Its points are none of the
        /// solver.
        /// </summary>
        /// <param name="points"><c>x0 y0 z0 x1 ...</c></param>
        /// <param name="triangles">Three indices of points each.</param>
        /// <returns>Its id.</returns>
        public int AddReferenceMesh(double[] points, IEnumerable<IReadOnlyList<int>> triangles)
        {
            int count = Flat.PointCount(points, nameof(points));
            var lists = new Lists<int>(triangles, nameof(triangles));
            int wrong = Array.FindIndex(lists.Counts, corners => corners != 3);
            if (wrong >= 0)
            {
                throw Refusal.Length($"{nameof(triangles)}[{wrong}]", "3 indices", $"{lists.Counts[wrong]}");
            }
            return handle.CheckNumber(
                Native.shapeop_addReferenceMesh(Usable, points, count, lists.Values, lists.Counts.Length));
        }

        /// <summary>The number of references; a problem replaces them.</summary>
        public int ReferenceCount
        {
            get { return handle.CheckNumber(Native.shapeop_referenceCount(Usable)); }
        }

        /// <summary>
        /// Adds a pressure on faces, shared among their corners. It follows the points, and iterations are plain with it.
        /// </summary>
        /// <param name="faces">
        /// The point indices of each, at least 3; a normal points to where they run counter-clockwise.
        /// </param>
        /// <param name="pressure">Force per area along the normals; below 0 against them.</param>
        /// <returns>Its id. Ids of forces count up from 0 and are never reused.</returns>
        public int AddPressure(IEnumerable<IReadOnlyList<int>> faces, double pressure)
        {
            var lists = new Lists<int>(faces, nameof(faces));
            return handle.CheckNumber(
                Native.shapeop_addPressure(
                    Usable, lists.Values, lists.Values.Length, lists.Counts, lists.Counts.Length, pressure));
        }

        /// <summary>
        /// Adds a force on every corner of faces along the normal there, that of the sum of the vector areas of the faces
        /// around it. It follows the points, and iterations are plain with it.
        /// </summary>
        /// <param name="faces">As in <see cref="AddPressure"/>.</param>
        /// <param name="magnitude">The length of the force; below 0 against the normals.</param>
        /// <returns>Its id. Ids of forces count up from 0 and are never reused.</returns>
        public int AddNormalForce(IEnumerable<IReadOnlyList<int>> faces, double magnitude)
        {
            var lists = new Lists<int>(faces, nameof(faces));
            return handle.CheckNumber(
                Native.shapeop_addNormalForce(
                    Usable, lists.Values, lists.Values.Length, lists.Counts, lists.Counts.Length, magnitude));
        }

        /// <summary>Replaces a pressure, or the length of a normal force.</summary>
        public void EditForceMagnitude(int id, double magnitude)
        {
            handle.Check(Native.shapeop_editForceMagnitude(Usable, id, magnitude));
        }
    }
}
