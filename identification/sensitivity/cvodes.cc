#include "identification/sensitivity/cvodes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include <cvodes/cvodes.h>
#include <cvodes/cvodes_ls.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_types.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

namespace continuum {
namespace {

constexpr int kRecoverable = 1, kFatal = -1;
constexpr long kMostInternalSteps = 100000;  // between two times that are asked for
// How often a step may be made shorter: at a corner, as where friction begins to slide, rates of
// sensitivities jump, and a step that ends beyond it is many orders of magnitude too long.
constexpr int kMostShorter = 40;

void Require(bool done) {
  if (!done) throw std::bad_alloc();
}

bool Finite(const double* y, std::size_t n) {
  return std::all_of(y, y + n, [](double v) { return std::isfinite(v); });
}

#if SUNDIALS_VERSION_MAJOR >= 7

SUNContext NewContext() {
  SUNContext made = nullptr;
  Require(SUNContext_Create(SUN_COMM_NULL, &made) == SUN_SUCCESS);
  Require(SUNContext_ClearErrHandlers(made) == SUN_SUCCESS);
  return made;
}

int BeQuiet(void*) { return CV_SUCCESS; }  // its context is

#else

SUNContext NewContext() {
  SUNContext made = nullptr;
  Require(SUNContext_Create(nullptr, &made) == 0);
  return made;
}

int BeQuiet(void* memory) {
  return CVodeSetErrHandlerFn(
      memory, [](int, const char*, const char*, char*, void*) {}, nullptr);
}

#endif

}  // namespace

// The C handles in the order in which they are made; they go in the opposite one.
struct Cvodes::Solver {
  template <class T>
  using Handle = std::unique_ptr<std::remove_pointer_t<T>, void (*)(T)>;

  static void FreeIteration(SUNNonlinearSolver solver) { SUNNonlinSolFree(solver); }

  Ode ode;
  Handle<SUNContext> context{nullptr, [](SUNContext c) { SUNContext_Free(&c); }};
  Handle<N_Vector> y{nullptr, N_VDestroy};
  std::vector<Handle<N_Vector>> columns;
  std::vector<N_Vector> s;  // those of columns
  Handle<SUNMatrix> matrix{nullptr, SUNMatDestroy};
  Handle<SUNLinearSolver> linear{nullptr, [](SUNLinearSolver l) { SUNLinSolFree(l); }};
  Handle<SUNNonlinearSolver> iteration{nullptr, FreeIteration}, iterations{nullptr, FreeIteration};
  Handle<void*> memory{nullptr, [](void* m) { CVodeFree(&m); }};
  std::exception_ptr thrown;
  Ode::States in, out;
  double t = 0;
  Work before;  // the last start

  Solver(const Ode& o, const SolverOptions& how) : ode(o), in(o.parameters), out(o.parameters) {
    SUNContext const made = NewContext();
    context.reset(made);
    const auto n = static_cast<sunindextype>(ode.size);
    y.reset(N_VNew_Serial(n, made));
    Require(y != nullptr);
    Set(N_VEnableFusedOps_Serial(y.get(), SUNTRUE));  // of its clones too
    N_VConst(0, y.get());
    for (std::size_t k = 0; k < ode.parameters; ++k) {
      columns.emplace_back(N_VClone(y.get()), N_VDestroy);
      s.push_back(columns.back().get());
      N_VConst(0, s.back());
    }
    memory.reset(CVodeCreate(how.stiff ? CV_BDF : CV_ADAMS, made));
    Require(memory != nullptr);
    Set(CVodeInit(memory.get(), Rate, 0, y.get()));
    Set(BeQuiet(memory.get()));
    Set(CVodeSetMaxHnilWarns(memory.get(), -1));  // SUNDIALS 7 prints them, whatever handles errors
    Set(CVodeSetUserData(memory.get(), this));
    Set(CVodeSStolerances(memory.get(), how.relative, how.absolute));
    Set(CVodeSetMaxNumSteps(memory.get(), kMostInternalSteps));
    Set(CVodeSetMaxErrTestFails(memory.get(), kMostShorter));
    if (how.stiff) {
      matrix.reset(SUNDenseMatrix(n, n, made));
      linear.reset(SUNLinSol_Dense(y.get(), matrix.get(), made));
      Require(matrix && linear);
      Set(CVodeSetLinearSolver(memory.get(), linear.get(), matrix.get()));
    } else {
      iteration.reset(SUNNonlinSol_FixedPoint(y.get(), 0, made));
      Require(iteration != nullptr);
      Set(CVodeSetNonlinearSolver(memory.get(), iteration.get()));
    }
    if (ode.parameters > 0) SetSensitivities(how);
  }

  void SetSensitivities(const SolverOptions& how) {
    const int count = static_cast<int>(ode.parameters);
    Set(CVodeSensInit(memory.get(), count, CV_STAGGERED, Sensitivity, s.data()));
    std::vector<double> absolute(ode.parameters, how.absolute);
    Set(CVodeSensSStolerances(memory.get(), how.relative, absolute.data()));
    Set(CVodeSetSensErrCon(memory.get(), SUNTRUE));
    if (how.stiff) return;
    iterations.reset(SUNNonlinSol_FixedPointSens(count, y.get(), 0, context.get()));
    Require(iterations != nullptr);
    Set(CVodeSetNonlinearSolverSensStg(memory.get(), iterations.get()));
  }

  static void Set(int flag) {
    if (flag == CV_SUCCESS) return;
    const std::unique_ptr<char, void (*)(void*)> name(CVodeGetReturnFlagName(flag), std::free);
    throw std::logic_error("CVODES: " + std::string(name.get()));
  }

  template <class Work>
  int Guarded(Work&& work) noexcept {
    try {
      return work() ? 0 : kRecoverable;
    } catch (...) {
      thrown = std::current_exception();
      return kFatal;
    }
  }

  static int Rate(double t, N_Vector y, N_Vector rate, void* self) {
    Solver& solver = *static_cast<Solver*>(self);
    return solver.Guarded([&] {
      double* const out = N_VGetArrayPointer(rate);
      solver.ode.rate(t, N_VGetArrayPointer(y), out);
      return Finite(out, solver.ode.size);
    });
  }

  static int Sensitivity(int, double t, N_Vector y, N_Vector rate, N_Vector* s, N_Vector* rates,
                         void* self, N_Vector, N_Vector) {
    Solver& solver = *static_cast<Solver*>(self);
    return solver.Guarded([&] {
      for (std::size_t k = 0; k < solver.ode.parameters; ++k) {
        solver.in[k] = N_VGetArrayPointer(s[k]);
        solver.out[k] = N_VGetArrayPointer(rates[k]);
      }
      solver.ode.sensitivity(t, N_VGetArrayPointer(y), N_VGetArrayPointer(rate), solver.in,
                             solver.out);
      return std::all_of(solver.out.begin(), solver.out.end(),
                         [&](const double* out) { return Finite(out, solver.ode.size); });
    });
  }
};

Cvodes::Cvodes(const Ode& ode, const SolverOptions& how)
    : solver_(std::make_unique<Solver>(ode, how)) {}

Cvodes::~Cvodes() = default;

void Cvodes::Start(double t, std::span<const double> y, std::span<const double> s) {
  Solver& solver = *solver_;
  const std::size_t n = solver.ode.size;
  std::copy(y.begin(), y.end(), N_VGetArrayPointer(solver.y.get()));
  for (std::size_t k = 0; k < solver.s.size(); ++k) {
    double* const column = N_VGetArrayPointer(solver.s[k]);
    if (s.empty()) {
      std::fill_n(column, n, 0.0);
    } else {
      std::copy_n(s.data() + k * n, n, column);
    }
  }
  Restart(t);
}

void Cvodes::Restart(double t) {
  Solver& solver = *solver_;
  solver.before = work();
  solver.t = t;
  Solver::Set(CVodeReInit(solver.memory.get(), t, solver.y.get()));
  if (!solver.s.empty())
    Solver::Set(CVodeSensReInit(solver.memory.get(), CV_STAGGERED, solver.s.data()));
}

bool Cvodes::Advance(double t, double stop) {
  Solver& solver = *solver_;
  Solver::Set(CVodeSetStopTime(solver.memory.get(), stop));
  int flag = CVode(solver.memory.get(), t, solver.y.get(), &solver.t, CV_NORMAL);
  if (flag >= 0 && !solver.s.empty())
    flag = CVodeGetSens(solver.memory.get(), &solver.t, solver.s.data());
  if (solver.thrown) std::rethrow_exception(std::exchange(solver.thrown, nullptr));
  if (flag >= 0) return true;
  const std::unique_ptr<char, void (*)(void*)> name(CVodeGetReturnFlagName(flag), std::free);
  failure_ = name.get();
  return false;
}

const double* Cvodes::y() const { return N_VGetArrayPointer(solver_->y.get()); }

const double* Cvodes::s(std::size_t k) const { return N_VGetArrayPointer(solver_->s[k]); }

Cvodes::Work& Cvodes::Work::operator+=(const Work& more) {
  steps += more.steps;
  rates += more.rates;
  sensitivity_rates += more.sensitivity_rates;
  return *this;
}

// The solver counts from its last start.
Cvodes::Work Cvodes::work() const {
  void* const memory = solver_->memory.get();
  Work work;
  long differences = 0;  // for Newton's matrix
  CVodeGetNumSteps(memory, &work.steps);
  CVodeGetNumRhsEvals(memory, &work.rates);
  if (solver_->linear) CVodeGetNumLinRhsEvals(memory, &differences);
  if (!solver_->s.empty()) CVodeGetSensNumRhsEvals(memory, &work.sensitivity_rates);
  work.rates += differences;
  return work += solver_->before;
}

}  // namespace continuum
