using System;
using Microsoft.Win32.SafeHandles;

namespace ShapeOp
{
    /// <summary>
    /// A solver of the library. It is deleted once: by <see cref="System.Runtime.InteropServices.SafeHandle.Dispose()"/> or
    /// the finalizer, but never while a call uses it, as every call counts as a reference.
    /// </summary>
    internal sealed class SolverHandle : SafeHandleZeroOrMinusOneIsInvalid
    {
        /// <summary>The null handle: for the messages of calls that have no solver.</summary>
        internal static readonly SolverHandle None = new SolverHandle();

        /// <summary>A null handle; the marshaller fills in what the library returns.</summary>
        public SolverHandle() : base(true)
        {
        }

        protected override bool ReleaseHandle()
        {
            Native.shapeop_delete(handle);
            return true;
        }

        /// <summary>Creates a solver.</summary>
        internal static SolverHandle Create()
        {
            SolverHandle created = Native.shapeop_create();
            if (created.IsInvalid)
            {
                // The library has no room for more. The collector knows nothing of that: solvers that nobody disposed of
                // may still wait for it.
                GC.Collect();
                GC.WaitForPendingFinalizers();
                created = Native.shapeop_create();
            }
            if (created.IsInvalid) throw None.Refusal();
            return created;
        }

        /// <summary>What the last call was refused for.</summary>
        internal ShapeOpException Refusal() =>
            new ShapeOpException(Native.shapeop_lastErrorCode(this), Text.FromLibrary(Native.shapeop_lastError(this)));

        /// <summary>For functions that answer with an error code.</summary>
        internal void Check(ErrorCode code)
        {
            if (code != ErrorCode.Success) throw new ShapeOpException(code, Text.FromLibrary(Native.shapeop_lastError(this)));
        }

        /// <summary>For functions without a result.</summary>
        internal void CheckLast()
        {
            if (Native.shapeop_lastErrorCode(this) != ErrorCode.Success) throw Refusal();
        }

        /// <summary>For functions that answer with a count, an id or a truth, or with -1.</summary>
        internal int CheckNumber(int number)
        {
            if (number < 0) throw Refusal();
            return number;
        }

        /// <summary>For functions without a solver that answer with a text, or with null.</summary>
        internal static string CheckText(IntPtr text)
        {
            if (text == IntPtr.Zero) throw None.Refusal();
            return Text.FromLibrary(text);
        }
    }
}
