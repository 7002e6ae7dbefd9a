// Calls code of a plugin; errors name the plugin and the hook. Not part of the public interface.
// Main thread only.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <type_traits>

#include "engine/app/options.hpp"
#include "engine/core/out_of_memory.hpp"

namespace psygen::app {

// Calls code of a plugin. Its errors and exceptions, std::bad_alloc among them, name it.
template <class F>
core::Result<void> call_plugin(const Plugin& plugin, std::string_view hook, const F& f) {
  return core::catch_exceptions(
      core::ErrorCode::kInternal, [&] { return fmt::format("plugin {}: {}", plugin.name, hook); },
      "threw",
      [&]() -> core::Result<void> {
        if constexpr (std::is_void_v<std::invoke_result_t<F>>) {
          f();
        } else if (const core::Result<void> ok = f(); !ok) {
          return core::fail(ok.error().code,
                            fmt::format("plugin {}: {}", plugin.name, ok.error().message));
        }
        return {};
      });
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
