// usage: load_plugin PLUGIN LIBRARY...
// Loads MuJoCo libraries, as Python does, and lets the first one load the plugin; prints its
// warnings and errors, and the number of effects.
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <mujoco/mujoco.h>

namespace {

void Print(const char* text) { std::printf("%s\n", text); }

[[noreturn]] void Stop(const char* text) {
  Print(text);
  std::exit(1);
}

#define FIND(name) reinterpret_cast<decltype(&name)>(dlsym(first, #name))

}  // namespace

int main(int argc, char** argv) {
  void* first = nullptr;
  for (int i = 2; i < argc; ++i) {
    void* const library = dlopen(argv[i], RTLD_NOW | RTLD_LOCAL);
    if (!library) Stop(dlerror());
    if (!first) first = library;
  }
  *FIND(mju_user_warning) = &Print;
  *FIND(mju_user_error) = &Stop;
  FIND(mj_loadPluginLibrary)(argv[1]);
  int effects = 0;
  for (int i = 0; i < FIND(mjp_pluginCount)(); ++i) {
    const mjpPlugin* const plugin = FIND(mjp_getPluginAtSlot)(i);
    effects += std::string_view(plugin->name).starts_with("continuum.");
  }
  std::printf("%d effects\n", effects);
  return 0;
}
