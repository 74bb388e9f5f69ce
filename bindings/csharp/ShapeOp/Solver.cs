using System;
using System.Collections.Generic;
using System.Runtime.ExceptionServices;
using System.Runtime.InteropServices;

namespace ShapeOp
{
    /// <summary>
    /// Points, constraints and forces, and the solver that moves the points so that the constraints are met as well as
    /// possible.
    /// </summary>
    /// <remarks>
    /// <para>Points are <c>x0 y0 z0 x1 ...</c> in model units. Angles are in radians, times in seconds.</para>
    /// <para>A refused call throws a <see cref="ShapeOpException"/> and changes nothing; after
    /// <see cref="Dispose"/> every call throws an <see cref="ObjectDisposedException"/>.</para>
    /// <para>Any thread may use a solver, one at a time: a call on a solver that another call is using is refused as
    /// busy. Different solvers can be used at the same time.</para>
    /// </remarks>
    public sealed partial class Solver : IDisposable
    {
        readonly SolverHandle handle;

        // Mono inlines nothing of a class with a static constructor before it ran, and so compiles no call of the library
        // before the library was found: see Library.Call.
        static Solver()
        {
        }

        /// <summary>A solver without points.</summary>
        /// <exception cref="DllNotFoundException">The native library is not found, or is of another version.</exception>
        /// <exception cref="ShapeOpException">65536 solvers exist.</exception>
        public Solver()
        {
            handle = Library.Call(SolverHandle.Create);
        }

        /// <summary>
        /// Deletes the solver; if a call is using it, at the end of that call. The finalizer does it otherwise.
        /// </summary>
        public void Dispose()
        {
            handle.Dispose();
        }

        /// <summary>
        /// Replaces everything by a problem in its JSON form, initialised for its mode, and returns its settings.
        /// </summary>
        /// <exception cref="ShapeOpException">The message names the place in the JSON.</exception>
        public SolveOptions SetProblem(string json)
        {
            byte[] text = Text.ToLibrary(json, nameof(json));
            var options = new SolveOptions();
            Native.shapeop_solve_options native = options.ToLibrary();
            handle.Check(Native.shapeop_setProblem(Usable, text, ref native));
            return new SolveOptions(native);
        }

        /// <summary>
        /// The positions: a copy when read. Their number may change as long as no constraint or force refers beyond it.
        /// Setting them moves nothing else: rest states, targets and velocities stay.
        /// </summary>
        public double[] Points
        {
            get
            {
                var points = new double[3 * PointCount];
                GetPoints(points);
                return points;
            }
            set
            {
                Native.shapeop_setPoints(Usable, value, Flat.PointCount(value, "points"));
                handle.CheckLast();
            }
        }

        /// <summary>Copies the positions into <paramref name="points"/>, which must have just their length.</summary>
        /// <remarks>It allocates nothing. From inside the function of a solve: the current iterate.</remarks>
        public void GetPoints(double[] points)
        {
            Native.shapeop_getPoints(Usable, points, Flat.PointCount(points, nameof(points)));
            handle.CheckLast();
        }

        /// <summary>The number of points.</summary>
        public int PointCount
        {
            get { return handle.CheckNumber(Native.shapeop_pointCount(Usable)); }
        }

        /// <summary>
        /// The number of points that no constraint of a weight above 0 holds. In static mode they keep their place.
        /// </summary>
        public int UnconstrainedCount
        {
            get { return handle.CheckNumber(Native.shapeop_unconstrainedCount(Usable)); }
        }

        /// <summary>
        /// Prepares for static solving from the current points. May be called again at any time.
        /// </summary>
        public void Init()
        {
            Native.shapeop_init(Usable);
            handle.CheckLast();
        }

        /// <summary>Prepares for dynamic solving from the current points with zero velocities.</summary>
        /// <param name="masses">The mass of every point, above 0.</param>
        /// <param name="damping">The factor on velocities after each step, at least 0.</param>
        /// <param name="timeStep">In seconds, above 0.</param>
        public void InitDynamic(double masses, double damping, double timeStep)
        {
            Native.shapeop_initDynamic(Usable, masses, damping, timeStep);
            handle.CheckLast();
        }

        /// <summary>
        /// Changes the time step of the following steps, but not the inertia, which keeps the step of
        /// <see cref="InitDynamic"/>. Before initialisation it has no effect.
        /// </summary>
        public void SetTimeStep(double timeStep)
        {
            Native.shapeop_setTimeStep(Usable, timeStep);
            handle.CheckLast();
        }

        /// <summary>Changes the damping of the following steps. Before initialisation it has no effect.</summary>
        public void SetDamping(double damping)
        {
            Native.shapeop_setDamping(Usable, damping);
            handle.CheckLast();
        }

        /// <summary>
        /// Sets the number of threads for large problems, at most 1024; 0, the default: as many as the machine has. The
        /// results are the same bits for any number.
        /// </summary>
        public void SetThreadCount(int threadCount)
        {
            handle.Check(Native.shapeop_setThreadCount(Usable, threadCount));
        }

        /// <summary>Sets how the following solves are accelerated.</summary>
        /// <param name="acceleration">The method.</param>
        /// <param name="memory">The number of iterations that it remembers, at most 64; 0: its default.</param>
        public void SetAcceleration(Acceleration acceleration, int memory = 0)
        {
            uint remembered = Refusal.Unsigned(memory, nameof(memory));
            handle.Check(Native.shapeop_setAcceleration(Usable, (int)acceleration, remembered));
        }

        /// <summary>Sets how the linear system of an iteration is solved, from the next solve on.</summary>
        public void SetLinearSolver(LinearSolver linearSolver)
        {
            handle.Check(Native.shapeop_setLinearSolver(Usable, (int)linearSolver));
        }

        /// <summary>
        /// What carries out the iterations of the following solves. The graphics card is refused as
        /// <see cref="ErrorCode.BackendUnavailable"/> where there is none, and by a library without the feature gpu. The
        /// report of a solve says what ran, and why.
        /// </summary>
        public Backend Backend
        {
            get { return (Backend)handle.CheckNumber(Native.shapeop_getBackend(Usable)); }
            set { handle.Check(Native.shapeop_setBackend(Usable, (int)value)); }
        }

        /// <summary>Chooses the graphics card of the following solves, and how much of it they may use.</summary>
        /// <param name="adapter">A part of its name, of any case; empty: any, the fastest kind first.</param>
        /// <param name="bindingBytes">Bytes of one binding at most; 0: what the card allows.</param>
        /// <param name="memoryBytes">Bytes of the card that the solver may take; 0: no limit.</param>
        public void SetBackendOptions(string adapter, long bindingBytes = 0, long memoryBytes = 0)
        {
            byte[] name = Text.ToLibrary(adapter, nameof(adapter));
            handle.Check(Native.shapeop_setBackendOptions(Usable, name, bindingBytes, memoryBytes));
        }

        /// <summary>The graphics card of this solver. The first call takes a while: it opens it.</summary>
        public BackendInfo GetBackendInfo()
        {
            var info = new Native.shapeop_backend_info
            {
                struct_size = (uint)Marshal.SizeOf<Native.shapeop_backend_info>(),
            };
            handle.Check(Native.shapeop_backendInfo(Usable, ref info));
            return new BackendInfo(info);
        }

        /// <summary>
        /// Static: so many iterations from the current points. Dynamic: one time step with so many iterations.
        /// </summary>
        public void Solve(int iterations)
        {
            Native.shapeop_solve(Usable, Refusal.Unsigned(iterations, nameof(iterations)));
            handle.CheckLast();
        }

        /// <summary>
        /// Iterates until the options say to stop, in dynamic mode within one time step, or until
        /// <paramref name="shouldStop"/> answers true.
        /// </summary>
        /// <param name="options">When to stop; null: the defaults.</param>
        /// <param name="shouldStop">
        /// Null, or called after every iteration on this thread. From inside, the solver can be read (points, counts,
        /// energy, violations) and nothing else. If it throws, the solve ends, what was reached is kept, and the
        /// exception is thrown here.
        /// </param>
        /// <exception cref="ShapeOpException">
        /// The call was refused. That a force acts along a motion that no constraint resists is no refusal, but the
        /// outcome <see cref="Outcome.Unbounded"/>.
        /// </exception>
        public Report SolveUntil(SolveOptions options = null, Func<Progress, bool> shouldStop = null)
        {
            Native.shapeop_solve_options native = (options ?? new SolveOptions()).ToLibrary();
            var report = new Native.shapeop_solve_report
            {
                struct_size = (uint)Marshal.SizeOf<Native.shapeop_solve_report>(),
            };
            // No exception may leave it: there is C behind it.
            ExceptionDispatchInfo failure = null;
            Native.shapeop_progress_callback callback = null;
            if (shouldStop != null)
            {
                callback = (ref Native.shapeop_progress progress, IntPtr user) =>
                {
                    try
                    {
                        return shouldStop(new Progress(progress)) ? 1 : 0;
                    }
                    catch (Exception error)
                    {
                        failure = ExceptionDispatchInfo.Capture(error);
                        return 1;
                    }
                };
            }
            ErrorCode code = Native.shapeop_solveUntil(Usable, ref native, callback, IntPtr.Zero, ref report);
            GC.KeepAlive(callback);
            failure?.Throw();
            handle.Check(code);
            bool hasMessage = report.outcome == Outcome.Unbounded || report.outcome == Outcome.BackendFailed;
            string message = hasMessage ? Text.FromLibrary(Native.shapeop_lastError(handle)) : null;
            // Whoever disposed of the solver in the callback asks for nothing more.
            string reason = handle.IsClosed ? "" : Text.FromLibrary(Native.shapeop_backendReason(handle));
            return new Report(report, reason, message);
        }

        /// <summary>
        /// The energy at the current points: half the sum of the weighted squared distances to the projections, in static
        /// mode minus the potential of the forces, in dynamic mode plus the inertia of the last step.
        /// </summary>
        public double Energy
        {
            get
            {
                var energy = new double[1];
                handle.Check(Native.shapeop_energy(Usable, energy));
                return energy[0];
            }
        }

        /// <summary>
        /// The violation of every constraint id at the current points, each in its type's unit
        /// (<see cref="ConstraintType.ViolationUnit"/>); 0 for removed ones.
        /// </summary>
        public double[] Violations
        {
            get
            {
                var violations = new double[ConstraintCount];
                handle.Check(Native.shapeop_getViolations(Usable, violations, violations.Length));
                return violations;
            }
        }

        /// <summary>The handle for a call of the library.</summary>
        SolverHandle Usable
        {
            get { return handle.IsClosed ? throw new ObjectDisposedException(typeof(Solver).FullName) : handle; }
        }
    }
}
