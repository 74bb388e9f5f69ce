using System;

namespace ShapeOp
{
    /// <summary>
    /// A call was refused, and changed nothing. The message names the argument, what was expected and what was found.
    /// </summary>
    public sealed class ShapeOpException : Exception
    {
        /// <summary>Why, as a code.</summary>
        public ErrorCode Code { get; }

        internal ShapeOpException(ErrorCode code, string message)
            // Without a message: another thread used the solver between the call and the question why.
            : base(message.Length > 0 ? message : Library.Call(() => Text.FromLibrary(Native.shapeop_errorText((int)code))))
        {
            Code = code;
        }
    }
}
