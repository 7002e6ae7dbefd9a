// Calls code of a plugin; errors name the plugin and the hook. Not part of the public interface.
// Main thread only.
#pragma once

#include <fmt/format.h>

#include <exception>
#include <new>
#include <string_view>
#include <type_traits>

#include "engine/app/options.hpp"
#include "engine/core/out_of_memory.hpp"

namespace psygen::app {

// Calls code of a plugin. Its errors and exceptions, std::bad_alloc among them, name it.
template <class F>
core::Result<void> call_plugin(const Plugin& plugin, std::string_view hook, const F& f) {
  const auto threw = [&](const char* what) {
    return core::fail(core::ErrorCode::kInternal,
                      fmt::format("plugin {}: {} threw: {}", plugin.name, hook, what));
  };
  try {
    if constexpr (std::is_void_v<std::invoke_result_t<F>>) {
      f();
    } else if (const core::Result<void> ok = f(); !ok) {
      return core::fail(ok.error().code,
                        fmt::format("plugin {}: {}", plugin.name, ok.error().message));
    }
    return {};
  } catch (const std::bad_alloc&) {
    return core::fail(core::ErrorCode::kOutOfMemory,
                      core::out_of_memory(fmt::format("plugin {}: {}", plugin.name, hook)));
  } catch (const std::exception& error) {
    return threw(error.what());
  } catch (...) {
    return threw("an exception of unknown type");
  }
}

// Calls a hook of all plugins that have it, in order, up to the first error.
template <class Hook, class... Args>
core::Result<void> call_plugins(const std::vector<Plugin>& plugins, Hook Plugin::*hook,
                                std::string_view name, Args&&... args) {
  for (const Plugin& plugin : plugins) {
    if (!(plugin.*hook)) continue;
    if (auto ok = call_plugin(plugin, name, [&] { return (plugin.*hook)(args...); }); !ok)
      return ok;
  }
  return {};
}

}  // namespace psygen::app
