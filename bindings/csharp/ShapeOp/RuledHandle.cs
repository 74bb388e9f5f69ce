using Microsoft.Win32.SafeHandles;

namespace ShapeOp
{
    /// <summary>A design of ruled strips of the library, deleted when nothing refers to it any more.</summary>
    internal sealed class RuledHandle : SafeHandleZeroOrMinusOneIsInvalid
    {
        /// <summary>A null handle; the marshaller fills in what the library returns.</summary>
        public RuledHandle() : base(true)
        {
        }

        protected override bool ReleaseHandle()
        {
            Native.shapeop_ruledDelete(handle);
            return true;
        }
    }
}
