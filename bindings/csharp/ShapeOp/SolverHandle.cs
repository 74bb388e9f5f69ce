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
            if (created.IsInvalid) throw new ShapeOpException(null, None.Message());
            return created;
        }

        /// <summary>Why the last call was refused; null if it was not.</summary>
        internal string Message()
        {
            string message = Text.FromLibrary(Native.shapeop_lastError(this));
            return message.Length == 0 ? null : message;
        }

        /// <summary>For functions that answer with an error code.</summary>
        internal void Check(ErrorCode code)
        {
            if (code != ErrorCode.Success) throw new ShapeOpException(code, Message());
        }

        /// <summary>For functions whose only sign of a refusal is the message.</summary>
        internal void CheckMessage()
        {
            string message = Message();
            if (message != null) throw new ShapeOpException(null, message);
        }

        /// <summary>For functions that answer with a count, an id or a truth, or with -1.</summary>
        internal int CheckNumber(int number)
        {
            if (number < 0) throw new ShapeOpException(null, Message());
            return number;
        }

        /// <summary>For functions without a solver that answer with a text, or with null.</summary>
        internal static string CheckText(IntPtr text)
        {
            if (text == IntPtr.Zero) throw new ShapeOpException(null, None.Message());
            return Text.FromLibrary(text);
        }
    }
}
