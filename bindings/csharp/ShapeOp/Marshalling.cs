using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.InteropServices;
using System.Text;

namespace ShapeOp
{
    /// <summary>Texts between .NET (UTF-16, with a length) and C (UTF-8, ended by a zero).</summary>
    internal static class Text
    {
        internal static byte[] ToLibrary(string text, string name)
        {
            if (text == null) throw Refusal.Null(name);
            int zero = text.IndexOf('\0');
            if (zero >= 0)
            {
                throw new ShapeOpException(
                    ErrorCode.InvalidInput, $"{name}: expected a text without zero characters, found one at {zero}");
            }
            return Encoding.UTF8.GetBytes(text + '\0');
        }

        /// <summary>A copy; the text belongs to the library. Null is the empty text.</summary>
        internal static string FromLibrary(IntPtr text)
        {
            if (text == IntPtr.Zero) return "";
            int length = 0;
            while (Marshal.ReadByte(text, length) != 0) length++;
            if (length == 0) return "";
            var bytes = new byte[length];
            Marshal.Copy(text, bytes, 0, length);
            return Encoding.UTF8.GetString(bytes);
        }
    }

    /// <summary>Refusals of what the library cannot see: null references, lengths, negative numbers made unsigned.</summary>
    internal static class Refusal
    {
        internal static ShapeOpException Null(string name)
        {
            return new ShapeOpException(ErrorCode.NullPointer, $"{name} is null");
        }

        internal static ShapeOpException Length(string name, string expected, string found)
        {
            return new ShapeOpException(ErrorCode.InvalidArgumentLength, $"{name}: expected {expected}, found {found}");
        }

        internal static uint Unsigned(int number, string name)
        {
            if (number < 0)
            {
                throw new ShapeOpException(ErrorCode.InvalidValue, $"{name}: expected at least 0, found {number}");
            }
            return (uint)number;
        }
    }

    /// <summary>Collections as the flat arrays of the C interface.</summary>
    internal static class Flat
    {
        /// <summary>The array itself if it is one, which is then pinned and not copied.</summary>
        internal static T[] Array<T>(IEnumerable<T> values, string name)
        {
            if (values == null) throw Refusal.Null(name);
            return values as T[] ?? values.ToArray();
        }

        /// <summary>The number of points in <c>x0 y0 z0 x1 ...</c>.</summary>
        internal static int PointCount(double[] points, string name)
        {
            if (points == null) throw Refusal.Null(name);
            if (points.Length % 3 != 0) throw Refusal.Length(name, "3 numbers for each point", $"{points.Length} numbers");
            return points.Length / 3;
        }
    }

    /// <summary>Lists behind each other.</summary>
    internal sealed class Lists<T>
    {
        internal T[] Values { get; }
        internal int[] Counts { get; }

        internal Lists(IEnumerable<IReadOnlyList<T>> lists, string name)
        {
            IReadOnlyList<T>[] array = Flat.Array(lists, name);
            Counts = new int[array.Length];
            long total = 0;
            for (int i = 0; i < array.Length; i++)
            {
                if (array[i] == null) throw Refusal.Null($"{name}[{i}]");
                Counts[i] = array[i].Count;
                total += Counts[i];
            }
            if (total > int.MaxValue) throw new ShapeOpException(ErrorCode.TooLarge, $"{name}: {total} entries are too many");
            Values = new T[total];
            int next = 0;
            foreach (IReadOnlyList<T> list in array)
            {
                for (int i = 0; i < list.Count; i++) Values[next++] = list[i];
            }
        }

        /// <summary>
        /// Refuses lists of scalars of unlike lengths: behind each other they could add up, and be read as others.
        /// </summary>
        /// <param name="type">What they are for; null if there is no such type, which the library then says.</param>
        /// <param name="pointCounts">The number of points of each constraint; null if it is not known.</param>
        /// <param name="name">The argument.</param>
        internal void RequireLikeLengths(ConstraintType type, int[] pointCounts, string name)
        {
            if (type == null || type.TakesShapes && pointCounts?.Length != Counts.Length) return;
            for (int i = 1; i < Counts.Length; i++)
            {
                // Shapes have as many points as their constraint has.
                long share = type.TakesShapes ? pointCounts[i] : 1;
                long firstShare = type.TakesShapes ? pointCounts[0] : 1;
                if (Counts[i] * firstShare != Counts[0] * share)
                {
                    throw Refusal.Length($"{name}[{i}]", $"a list like the first, of {Counts[0]}", $"{Counts[i]} numbers");
                }
            }
        }
    }
}
