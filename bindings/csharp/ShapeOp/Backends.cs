using System.Runtime.InteropServices;

namespace ShapeOp
{
    /// <summary>The graphics card that iterates, and its limits.</summary>
    public sealed class BackendInfo
    {
        /// <summary>Its name.</summary>
        public string Adapter { get; }

        /// <summary>Its kind.</summary>
        public AdapterKind Kind { get; }

        /// <summary>The interface it is driven by, such as "vulkan".</summary>
        public string Api { get; }

        /// <summary>The driver, and its version.</summary>
        public string Driver { get; }

        /// <summary>Bytes of one buffer at most.</summary>
        public long BufferBytes { get; }

        /// <summary>Bytes of what one binding reaches at most; what is larger is split.</summary>
        public long BindingBytes { get; }

        /// <summary>Workgroups at most, in one dimension of a run.</summary>
        public int GroupCount { get; }

        internal BackendInfo(Native.shapeop_backend_info info)
        {
            Adapter = Text.FromLibrary(info.adapter);
            Kind = info.kind;
            Api = Text.FromLibrary(info.api);
            Driver = Text.FromLibrary(info.driver);
            BufferBytes = (long)info.buffer_bytes;
            BindingBytes = (long)info.binding_bytes;
            GroupCount = info.group_count > int.MaxValue ? int.MaxValue : (int)info.group_count;
        }

        /// <summary>
        /// Gives the graphics card back, with all memory that solvers have on it: for a host that needs it for something
        /// else. Solves that run on it end with <see cref="Outcome.BackendFailed"/>, at the points of their last
        /// read-back; later ones open it again. Where there is nothing to give back, it does nothing.
        /// </summary>
        public static void Release()
        {
            Library.Call(() =>
            {
                SolverHandle.None.Check(Native.shapeop_releaseBackend());
                return true;
            });
        }
    }
}
