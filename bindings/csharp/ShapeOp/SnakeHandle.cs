using Microsoft.Win32.SafeHandles;

namespace ShapeOp
{
    /// <summary>A circular arc snake of the library, deleted when nothing refers to it any more.</summary>
    internal sealed class SnakeHandle : SafeHandleZeroOrMinusOneIsInvalid
    {
        /// <summary>A null handle; the marshaller fills in what the library returns.</summary>
        public SnakeHandle() : base(true)
        {
        }

        protected override bool ReleaseHandle()
        {
            Native.shapeop_snakeDelete(handle);
            return true;
        }
    }
}
