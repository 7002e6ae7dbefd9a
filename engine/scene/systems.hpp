// The extension points of a scene: a game adds components and entities, systems that run once a
// frame among the engine's (docs/architecture.md lists their names), and systems that run once a
// fixed step. Systems of a frame may read Clock, Camera, Input, View, WorldFacts, Quality and
// FixedStep and write Input; systems of a step may read WorldFacts and FixedStep. Both may use
// components, event queues, telemetry::Marks and their own resources. Main thread only.
#pragma once

#include <utility>

#include "ecs/ecs.hpp"
#include "engine/telemetry/own_figures.hpp"

namespace psygen::scene {

// The argument of app::Plugin::add_systems.
struct Systems {
  ecs::World& entities;
  ecs::Schedule& frame;
  ecs::Schedule& step;
  telemetry::OwnFigures& figures;  // declares the game's figures

  // Makes a resource for both kinds of systems. It lives as long as the scene.
  template <class R, class... Args>
  R& resource(Args&&... args) {
    R& made = frame.emplace<R>(std::forward<Args>(args)...);
    step.provide(made);
    return made;
  }
};

}  // namespace psygen::scene
