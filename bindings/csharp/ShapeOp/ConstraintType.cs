using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.InteropServices;

namespace ShapeOp
{
    /// <summary>One scalar of a constraint type.</summary>
    public sealed class ConstraintScalar
    {
        /// <summary>Its name, ending in its unit unless it is in model units or has none.</summary>
        public string Name { get; }

        /// <summary>The default; null where the points at creation decide.</summary>
        public double? Default { get; }

        internal ConstraintScalar(Native.shapeop_constraint_scalar scalar)
        {
            Name = Text.FromLibrary(scalar.name);
            Default = scalar.has_default != 0 ? scalar.default_value : (double?)null;
        }
    }

    /// <summary>A constraint type, as the library describes it.</summary>
    public sealed class ConstraintType
    {
        /// <summary>All types of the library.</summary>
        /// <exception cref="DllNotFoundException">The native library is not found, or is of another version.</exception>
        public static IReadOnlyList<ConstraintType> All
        {
            get { return Library.Call(Read); }
        }

        /// <summary>The type of that name, or null.</summary>
        public static ConstraintType Find(string name)
        {
            return All.FirstOrDefault(type => type.Name == name);
        }

        /// <summary>The name by which constraints are added.</summary>
        public string Name { get; }

        /// <summary>One line for people.</summary>
        public string Help { get; }

        /// <summary>The least number of point indices.</summary>
        public int LeastIndices { get; }

        /// <summary>The greatest number of point indices; null: any number.</summary>
        public int? GreatestIndices { get; }

        /// <summary>
        /// What each point index means, such as "apex"; the last name stands for all that follow. May be empty.
        /// </summary>
        public IReadOnlyList<string> IndexNames { get; }

        /// <summary>
        /// True if its scalars are shapes: <c>x y z</c> of each of the constraint's points, one or more times.
        /// </summary>
        public bool TakesShapes { get; }

        /// <summary>Its scalars; empty if it takes shapes, or none.</summary>
        public IReadOnlyList<ConstraintScalar> Scalars { get; }

        /// <summary>What its projection promises.</summary>
        public Projection Projection { get; }

        /// <summary>
        /// True if it sees its points only relative to their mean, so that alone it leaves translations free.
        /// </summary>
        public bool IsCentred { get; }

        /// <summary>The power of the model's scale with which its energy grows.</summary>
        public int EnergyScalePower { get; }

        /// <summary>The unit of its violation, such as "model units" or "rad".</summary>
        public string ViolationUnit { get; }

        /// <summary>Another type's name that <see cref="Solver.Edit"/> takes for it too, or null.</summary>
        public string EditedAs { get; }

        ConstraintType(int index, Native.shapeop_constraint_type type)
        {
            Name = Text.FromLibrary(type.name);
            Help = Text.FromLibrary(type.help);
            LeastIndices = type.least_indices;
            GreatestIndices = type.greatest_indices < 0 ? (int?)null : type.greatest_indices;
            IndexNames = Enumerable.Range(0, type.index_name_count)
                .Select(position => SolverHandle.CheckText(Native.shapeop_constraintIndexName(index, position)))
                .ToArray();
            TakesShapes = type.scalar_count < 0;
            Scalars = Enumerable.Range(0, Math.Max(0, type.scalar_count)).Select(i => ReadScalar(index, i)).ToArray();
            Projection = type.projection;
            IsCentred = type.is_centred != 0;
            EnergyScalePower = type.energy_scale_power;
            ViolationUnit = Text.FromLibrary(type.violation_unit);
            EditedAs = type.edited_as == IntPtr.Zero ? null : Text.FromLibrary(type.edited_as);
        }

        /// <summary>The types of the library do not change while it is loaded, so they are read once.</summary>
        static ConstraintType[] read;

        static ConstraintType[] Read()
        {
            if (read == null)
            {
                int count = SolverHandle.None.CheckNumber(Native.shapeop_constraintTypeCount());
                read = Enumerable.Range(0, count).Select(ReadType).ToArray();
            }
            return read;
        }

        static ConstraintType ReadType(int index)
        {
            var type = new Native.shapeop_constraint_type
            {
                struct_size = (uint)Marshal.SizeOf<Native.shapeop_constraint_type>(),
            };
            SolverHandle.None.Check(Native.shapeop_constraintType(index, ref type));
            return new ConstraintType(index, type);
        }

        static ConstraintScalar ReadScalar(int index, int scalarIndex)
        {
            var scalar = new Native.shapeop_constraint_scalar
            {
                struct_size = (uint)Marshal.SizeOf<Native.shapeop_constraint_scalar>(),
            };
            SolverHandle.None.Check(Native.shapeop_constraintScalar(index, scalarIndex, ref scalar));
            return new ConstraintScalar(scalar);
        }
    }
}
