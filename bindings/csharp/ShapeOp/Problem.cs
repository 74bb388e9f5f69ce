using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.InteropServices;

namespace ShapeOp
{
    /// <summary>
    /// Problems in their JSON form (<c>docs/problem.schema.json</c>): points, constraints, forces and settings. A solver
    /// takes one with <see cref="Solver.SetProblem"/>.
    /// </summary>
    public static class Problem
    {
        /// <summary>The same problem in its canonical form: checked, and with the defaults filled in.</summary>
        /// <exception cref="ShapeOpException">The message names the place in the JSON.</exception>
        public static string Canonical(string json)
        {
            byte[] text = Text.ToLibrary(json, nameof(json));
            return Library.Call(() => SolverHandle.CheckText(Native.shapeop_problemText(text)));
        }

        /// <summary>The names of the recipes that <see cref="FromRecipe"/> knows.</summary>
        public static IReadOnlyList<string> Recipes
        {
            get { return Library.Call(() => Names.Read(Native.shapeop_recipeCount(), Native.shapeop_recipeName)); }
        }

        /// <summary>Makes a problem from a mesh.</summary>
        /// <param name="recipe">One of <see cref="Recipes"/>.</param>
        /// <param name="points"><c>x0 y0 z0 x1 ...</c></param>
        /// <param name="faces">The point indices of each face.</param>
        /// <param name="options">Null: the library's defaults.</param>
        /// <returns>The problem in its JSON form.</returns>
        public static string FromRecipe(
            string recipe, double[] points, IEnumerable<IReadOnlyList<int>> faces, RecipeOptions options = null)
        {
            byte[] name = Text.ToLibrary(recipe, nameof(recipe));
            int pointCount = Flat.PointCount(points, nameof(points));
            var lists = new Lists<int>(faces, nameof(faces));
            RecipeOptions given = options ?? new RecipeOptions();
            int[] anchors = Flat.Array(given.Anchors, nameof(given.Anchors));
            GCHandle pinned = GCHandle.Alloc(anchors, GCHandleType.Pinned);
            try
            {
                Native.shapeop_recipe_options native = given.ToLibrary(pinned.AddrOfPinnedObject(), anchors.Length);
                return Library.Call(
                    () => SolverHandle.CheckText(
                        Native.shapeop_recipe(
                            name, points, pointCount, lists.Values, lists.Values.Length, lists.Counts,
                            lists.Counts.Length, ref native)));
            }
            finally
            {
                pinned.Free();
            }
        }
    }

    /// <summary>Options of <see cref="Problem.FromRecipe"/>. New ones have the library's defaults.</summary>
    public sealed class RecipeOptions
    {
        /// <summary>The weight of the recipe's own constraints.</summary>
        public double Weight { get; set; }

        /// <summary>The weight that draws each point to where it was; 0 for none.</summary>
        public double Closeness { get; set; }

        /// <summary>The weight of fairness; 0 for none.</summary>
        public double Fairness { get; set; }

        /// <summary>True: fairness smooths; false: it keeps the details of the design.</summary>
        public bool IsSmoothing { get; set; }

        /// <summary>
        /// In model units: the length that "equalize" draws edges to; 0: their mean. The distance that "rationalize" allows the
        /// diagonals of a quad; 0: planar quads. Other recipes refuse it.
        /// </summary>
        public double Length { get; set; }

        /// <summary>The points that keep their place.</summary>
        public IEnumerable<int> Anchors { get; set; } = new int[0];

        /// <summary>Whether all points of the boundary keep their place too.</summary>
        public bool AnchorBoundary { get; set; }

        /// <summary>
        /// Whether the corners of the boundary keep their place too, where it turns by more than 75 degrees.
        /// </summary>
        public bool AnchorCorners { get; set; }

        /// <summary>The library's defaults.</summary>
        public RecipeOptions()
        {
            Native.shapeop_recipe_options options = Library.Call(Defaults);
            IsSmoothing = options.fairness_kind != 0;
            Weight = options.weight;
            Closeness = options.closeness;
            Fairness = options.fairness;
            Length = options.length;
            AnchorBoundary = options.anchor_boundary != 0;
            AnchorCorners = options.anchor_corners != 0;
        }

        internal Native.shapeop_recipe_options ToLibrary(IntPtr anchors, int anchorCount)
        {
            Native.shapeop_recipe_options options = Defaults();
            options.fairness_kind = IsSmoothing ? 1 : 0;
            options.weight = Weight;
            options.closeness = Closeness;
            options.fairness = Fairness;
            options.length = Length;
            options.anchors = anchors;
            options.nb_anchors = anchorCount;
            options.anchor_boundary = AnchorBoundary ? 1 : 0;
            options.anchor_corners = AnchorCorners ? 1 : 0;
            return options;
        }

        static Native.shapeop_recipe_options Defaults()
        {
            var options = new Native.shapeop_recipe_options
            {
                struct_size = (uint)Marshal.SizeOf<Native.shapeop_recipe_options>(),
            };
            SolverHandle.None.Check(Native.shapeop_defaultRecipeOptions(ref options));
            return options;
        }
    }

    /// <summary>Measures of the faces of a mesh.</summary>
    public static class Measure
    {
        /// <summary>The names of the measures.</summary>
        public static IReadOnlyList<string> All
        {
            get { return Library.Call(() => Names.Read(Native.shapeop_measureCount(), Native.shapeop_measureName)); }
        }

        /// <summary>The measure of each face.</summary>
        /// <param name="measure">One of <see cref="All"/>.</param>
        /// <param name="points"><c>x0 y0 z0 x1 ...</c></param>
        /// <param name="faces">The point indices of each face.</param>
        public static double[] Faces(string measure, double[] points, IEnumerable<IReadOnlyList<int>> faces)
        {
            byte[] name = Text.ToLibrary(measure, nameof(measure));
            int pointCount = Flat.PointCount(points, nameof(points));
            var lists = new Lists<int>(faces, nameof(faces));
            var measured = new double[lists.Counts.Length];
            return Library.Call(
                () =>
                {
                    SolverHandle.None.Check(
                        Native.shapeop_measureFaces(
                            name, points, pointCount, lists.Values, lists.Values.Length, lists.Counts,
                            lists.Counts.Length, measured, measured.Length));
                    return measured;
                });
        }
    }

    /// <summary>Names that the library lists.</summary>
    internal static class Names
    {
        internal static string[] Read(int count, Func<int, IntPtr> name)
        {
            return Enumerable.Range(0, SolverHandle.None.CheckNumber(count))
                .Select(index => SolverHandle.CheckText(name(index)))
                .ToArray();
        }
    }
}
