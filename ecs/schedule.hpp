// Systems in one readable order. A system is a function; its parameters say what it reads and
// writes:
//   Query<A, const B>     writes the component A, reads B
//   const R& / R&         reads / writes a resource: any object given to provide()
//   EventQueue<T>&        emits events; the queue is a resource
//   EventReader<T>&       the system's own reader of a queue: sees every event once
//   ChangeReader<C, Tag>& drains a reader that was provided; reads C. The schedule cannot see a
//                         reader inside another resource, so its drain could overlap writers of C
//   Commands&             structural changes, applied right after the system
//   World& / const World& everything: alone / beside others that only read
//   a bundle, by value    a struct of references, or of other bundles: stands for its members
// Systems run in the order of add(), or where their constraints put them. On several threads,
// systems that do not conflict run at the same time, and the result equals that of one thread. Not
// a job system: a system that wants to split its own work does so itself. One thread owns the
// schedule.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "ecs/change_reader.hpp"
#include "ecs/commands.hpp"
#include "ecs/event_queue.hpp"
#include "ecs/system_order.hpp"
#include "ecs/system_query.hpp"

namespace psygen::ecs {

// Threads that may run a system.
enum class RunsOn : std::uint8_t {
  kAnyThread,
  kCallingThread,  // the one that calls run(): windows, graphics interfaces
};

// Access of a system to the world beyond the components that it lists.
enum class WorldAccess : std::uint8_t { kNone, kReads, kWrites };

// One component or resource that a system uses.
struct Access {
  std::string name;  // of the component, or the type of the resource without its namespace
  const void* type;  // identity of the type, unique in the program
  bool writes;
  bool is_component;
  std::string bundle = {};  // outermost bundle that names it, without its namespace; or empty
  bool is_reader = false;   // the system's own EventReader, beside which it may take the queue
};

// A system's accesses and times. Times are in seconds; they are 0 before the first run.
struct SystemInfo {
  std::string name;
  std::vector<Access> accesses;  // in the order of the parameters
  WorldAccess world = WorldAccess::kNone;
  bool records_commands = false;
  RunsOn runs_on = RunsOn::kAnyThread;
  double last_start_s = 0;      // start of its last run, on std::chrono::steady_clock
  double last_seconds = 0;      // wall time of the last run, including its commands
  std::uint64_t last_work = 0;  // counted in the last run, including its commands (count_work())
};

// Reads a counter that grows with the work of the calling thread: instructions, processor time.
using WorkCounter = std::uint64_t (*)();

// True if the order of two systems matters. Symmetric. O(accesses of a * accesses of b).
bool conflict(const SystemInfo& a, const SystemInfo& b);

// Owns its systems and its worker threads; the world and the resources must outlive it.
class Schedule {
 public:
  // `threads` (at most 64) includes the calling one: 1 runs everything there, in order. If the
  // operating system grants fewer, threads() returns their number.
  explicit Schedule(World& world, std::size_t threads = 1);
  // Stops and joins the worker threads. Not during run().
  ~Schedule();
  Schedule(const Schedule&) = delete;
  Schedule& operator=(const Schedule&) = delete;

  // Makes an object known to systems by its type, one object per type; arrange() reports a second
  // one. It must outlive the schedule.
  template <class... Rs>
  void provide(Rs&... resources) {
    static_assert((!std::is_const_v<Rs> && ...),
                  "provide what can be written; systems that take const R& only read it");
    (provide_one(&kIdentity<Rs>, type_label<Rs>(), &resources), ...);
  }

  // Like provide(), with an object that the schedule makes and owns.
  template <class R, class... Args>
  R& emplace(Args&&... args) {
    std::shared_ptr<R> owned(new R{std::forward<Args>(args)...});
    R& resource = *owned;
    provide(resource);
    own(std::move(owned));
    return resource;
  }

  // Adds a system. Provide its resources first: a system with a missing one, or with one that the
  // parameters name twice, is left out, and arrange() reports it. Not from inside a system.
  // O(systems).
  template <class F>
  void add(std::string_view name, F system, RunsOn runs_on = RunsOn::kAnyThread) {
    add(name, std::move(system), Place{}, runs_on);
  }
  // Adds a system with constraints, which may name systems that are added later. Names must be
  // unique.
  template <class F>
  void add(std::string_view name, F system, Place place, RunsOn runs_on = RunsOn::kAnyThread);

  // Sorts all systems by their constraints. Returns an empty string, or a message if add() or
  // provide() were refused or no such order exists: a repeated name, an unknown name, a cycle. The
  // order is then unchanged. O(systems²), and O(1) if nothing was added since.
  std::string arrange();

  // Runs every system once, commands included, and returns when all are done. Arranges them first,
  // and ends the program if that is impossible. Not from inside a system. An exception of a system
  // ends the run: no other system starts, commands that were not applied are dropped, and run()
  // throws the exception on. threw() names the system then.
  void run();
  // Counts the work of each system from the next run on (SystemInfo::last_work); null ends it. Not
  // during run().
  void count_work(WorkCounter read);
  // The system whose exception ended the last run; empty if none did.
  const std::string& threw() const;

  // The systems in the order of execution, once arranged. Valid until the next add() or arrange();
  // times change during run().
  std::span<const SystemInfo> systems() const;
  // Number of threads that run systems, the calling one included: 1 to 64.
  std::size_t threads() const;

 private:
  template <class T>
  static constexpr char kIdentity = 0;
  template <class T>
  static std::string type_label();

  // A function with its parameters, owned.
  class Runner {
   public:
    virtual ~Runner() = default;
    virtual void run() = 0;
  };
  template <class F, class... Ps>
  class RunnerOf;
  // A system with its parameters bound; `commands` is null if it records none.
  struct System {
    SystemInfo info;
    Place place;
    std::unique_ptr<Runner> runner;
    std::unique_ptr<Commands> commands;
  };
  struct Parts;

  // A parameter of a system: records its accesses, and gets its value when the system runs.
  template <class P>
  struct Parameter;
  template <class F, class... Ps>
  void add_with(System system, F f, std::type_identity<std::tuple<Ps...>>);

  // The untyped parts of provide and add. resource() and append() throw a detail::Refusal if
  // `asker` needs a type that was not provided, or `system` one twice.
  void provide_one(const void* type, std::string label, void* resource);
  void own(std::shared_ptr<void> resource);
  void* resource(const System& asker, const void* type, const std::string& label) const;
  void append(System system);
  void refuse(std::string sentence);
  void run_on_threads();

  World& world_;
  std::unique_ptr<Parts> parts_;
};

namespace detail {

// Leads from a parameter to Schedule::add(), which catches it: the system is left out.
struct Refusal {
  std::string sentence;
};

// The parameters of a function pointer, or of an object with one operator(), as a tuple type.
template <class F>
struct ParametersOf {
  using type = typename ParametersOf<decltype(&F::operator())>::type;
};
template <class R, bool N, class... Ps>
struct ParametersOf<R (*)(Ps...) noexcept(N)> : std::type_identity<std::tuple<Ps...>> {};
template <class R, class F, bool N, class... Ps>
struct ParametersOf<R (F::*)(Ps...) noexcept(N)> : std::type_identity<std::tuple<Ps...>> {};
template <class R, class F, bool N, class... Ps>
struct ParametersOf<R (F::*)(Ps...) const noexcept(N)> : std::type_identity<std::tuple<Ps...>> {};

// True if T is a Query.
template <class T>
inline constexpr bool kIsQuery = false;
template <class... Cs>
inline constexpr bool kIsQuery<Query<Cs...>> = true;

// A struct of references, or of such structs.
template <class T>
concept Bundle = std::is_class_v<T> && std::is_aggregate_v<T> && !std::is_empty_v<T> &&
                 std::is_trivially_copy_constructible_v<T> && !std::is_copy_assignable_v<T> &&
                 !std::is_default_constructible_v<T>;

// The type of the events of an EventQueue; others have none.
template <class T>
struct EventOf : std::type_identity<void> {};
template <class T>
struct EventOf<EventQueue<T>> : std::type_identity<T> {};

// Returns the name without its namespaces; template arguments keep theirs.
std::string without_namespace(std::string_view name);

}  // namespace detail

// A queue has the label of its events.
template <class T>
std::string Schedule::type_label() {
  using Event = typename detail::EventOf<T>::type;
  if constexpr (!std::is_void_v<Event>) return type_label<Event>();
  return detail::without_namespace(detail::type_name<T>());
}

// const R& or R&: a resource. In all specialisations, the constructor records the accesses in
// `system`, and get() makes the argument of one run.
template <class P>
struct Schedule::Parameter {
  static_assert(std::is_lvalue_reference_v<P>,
                "a system takes Query<...> and bundles (structs of references) by value, "
                "everything else by reference");
  using R = std::remove_cvref_t<P>;
  static_assert(!detail::Bundle<R>, "a system takes a bundle by value");
  static_assert(!detail::kIsQuery<R> && !std::is_same_v<R, Commands>,
                "a system takes Query<...> by value and Commands by a reference to write");
  R* resource;
  Parameter(Schedule& schedule, System& system)
      : resource(static_cast<R*>(schedule.resource(system, &kIdentity<R>, type_label<R>()))) {
    system.info.accesses.push_back(
        {type_label<R>(), &kIdentity<R>, !std::is_const_v<std::remove_reference_t<P>>, false});
  }
  P get() const { return *resource; }
};

// Query<Cs...>: declares its components in the world.
template <class... Cs>
struct Schedule::Parameter<Query<Cs...>> {
  World& world;
  Parameter(Schedule& schedule, System& system) : world(schedule.world_) {
    world.declare<std::remove_const_t<Cs>...>();
    (system.info.accesses.push_back(
         {detail::without_namespace(component_name<std::remove_const_t<Cs>>()),
          &kIdentity<std::remove_const_t<Cs>>, !std::is_const_v<Cs>, true}),
     ...);
  }
  Query<Cs...> get() const { return Query<Cs...>(world); }
};

// The system's own reader of a queue. Draining it also changes the queue.
template <class T>
struct Schedule::Parameter<EventReader<T>&> {
  std::unique_ptr<EventReader<T>> reader;
  Parameter(Schedule& schedule, System& system) {
    using Queue = EventQueue<T>;
    auto* queue =
        static_cast<Queue*>(schedule.resource(system, &kIdentity<Queue>, type_label<Queue>()));
    reader = std::make_unique<EventReader<T>>(queue->reader());
    system.info.accesses.push_back({.name = type_label<Queue>(),
                                    .type = &kIdentity<Queue>,
                                    .writes = true,
                                    .is_component = false,
                                    .is_reader = true});
  }
  EventReader<T>& get() const { return *reader; }
};

// A provided change reader: writes the reader, reads C.
template <class C, class Tag>
struct Schedule::Parameter<ChangeReader<C, Tag>&> {
  using Reader = ChangeReader<C, Tag>;
  Reader* reader;
  Parameter(Schedule& schedule, System& system)
      : reader(static_cast<Reader*>(
            schedule.resource(system, &kIdentity<Reader>, type_label<Reader>()))) {
    system.info.accesses.push_back({type_label<Reader>(), &kIdentity<Reader>, true, false});
    system.info.accesses.push_back(
        {detail::without_namespace(component_name<C>()), &kIdentity<C>, false, true});
  }
  Reader& get() const { return *reader; }
};

// The system's own Commands; two such parameters are the same object.
template <>
struct Schedule::Parameter<Commands&> {
  Commands* commands;
  Parameter(Schedule&, System& system) {
    system.info.records_commands = true;
    if (system.commands == nullptr) system.commands = std::make_unique<Commands>();
    commands = system.commands.get();
  }
  Commands& get() const { return *commands; }
};

// A bundle: accesses what its members access. Built once, when the system is added: resources stay
// where they are.
template <detail::Bundle B>
struct Schedule::Parameter<B> {
  B bundle;
  Parameter(Schedule& schedule, System& system)
      : bundle(make(schedule, system, std::make_index_sequence<count()>{})) {}
  B get() const { return bundle; }

 private:
  // Converts to each member in turn, and records the member's accesses.
  struct Member {
    Schedule& schedule;
    System& system;
    template <class T>
    requires(!detail::Bundle<T>) operator T&() const {
      static_assert(std::is_trivially_copyable_v<Parameter<T&>>,
                    "readers and Commands are parameters of their own, not members of a bundle");
      return Parameter<T&>(schedule, system).get();
    }
    template <detail::Bundle T>
    operator T() const {
      return Parameter<T>(schedule, system).get();
    }
  };
  // The number of members. References take neither more values nor fewer.
  template <std::size_t Max = 16>
  static constexpr std::size_t count() {
    constexpr bool fits = []<std::size_t... I>(std::index_sequence<I...>) {
      return requires(Member m) {
        B{(void(I), m)...};
      };
    }
    (std::make_index_sequence<Max>{});
    static_assert(fits || Max > 1, "a bundle has 1 to 16 members, each a reference or a bundle");
    if constexpr (fits || Max <= 1)
      return Max;
    else
      return count<Max - 1>();
  }
  template <std::size_t... I>
  static B make(Schedule& schedule, System& system, std::index_sequence<I...>) {
    const std::size_t first = system.info.accesses.size();
    const B made{(void(I), Member{schedule, system})...};  // from left to right
    for (Access& access : std::span(system.info.accesses).subspan(first))
      access.bundle = type_label<B>();
    return made;
  }
};

// The world, to change it.
template <>
struct Schedule::Parameter<World&> {
  World& world;
  Parameter(Schedule& schedule, System& system) : world(schedule.world_) {
    system.info.world = WorldAccess::kWrites;
  }
  World& get() const { return world; }
};

// The world, only to read it.
template <>
struct Schedule::Parameter<const World&> {
  const World& world;
  Parameter(Schedule& schedule, System& system) : world(schedule.world_) {
    system.info.world = WorldAccess::kReads;
  }
  const World& get() const { return world; }
};

template <class F>
void Schedule::add(std::string_view name, F system, Place place, RunsOn runs_on) {
  System entry;
  entry.info.name = name;
  entry.place = std::move(place);
  entry.info.runs_on = runs_on;
  try {
    add_with(std::move(entry), std::move(system),
             std::type_identity<typename detail::ParametersOf<F>::type>{});
  } catch (detail::Refusal& refusal) {
    refuse(std::move(refusal.sentence));
  }
}

// Calls the function with the value of each parameter.
template <class F, class... Ps>
class Schedule::RunnerOf : public Runner {
 public:
  RunnerOf(F f, std::tuple<Parameter<Ps>...> parameters)
      : f_(std::move(f)), parameters_(std::move(parameters)) {}
  void run() override {
    std::apply([this](auto&... each) { f_(each.get()...); }, parameters_);
  }

 private:
  F f_;
  std::tuple<Parameter<Ps>...> parameters_;
};

template <class F, class... Ps>
void Schedule::add_with(System system, F f, std::type_identity<std::tuple<Ps...>>) {
  // Braces evaluate from left to right, which lists accesses in the order of the parameters.
  std::tuple<Parameter<Ps>...> parameters{Parameter<Ps>(*this, system)...};
  system.runner = std::make_unique<RunnerOf<F, Ps...>>(std::move(f), std::move(parameters));
  append(std::move(system));
}

}  // namespace psygen::ecs
