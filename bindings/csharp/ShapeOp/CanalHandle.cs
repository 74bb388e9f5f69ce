using Microsoft.Win32.SafeHandles;

namespace ShapeOp
{
    /// <summary>A surface of the library, deleted when nothing refers to it any more.</summary>
    internal sealed class CanalHandle : SafeHandleZeroOrMinusOneIsInvalid
    {
        /// <summary>A null handle; the marshaller fills in what the library returns.</summary>
        public CanalHandle() : base(true)
        {
        }

        protected override bool ReleaseHandle()
        {
            Native.shapeop_canalDelete(handle);
            return true;
        }
    }
}
