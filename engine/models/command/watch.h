#pragma once
/// Ends the process groups that this process leaves behind, however it ends. Private to this folder.
#include <sys/types.h>

namespace gumshoe::models {

/// While it lives, the group `pid` and all in it are killed when this process ends, even by SIGKILL. A small process of
/// its own watches: the kernel tells only children of the death of their parent, not their children.
class Watch {
public:
  explicit Watch(pid_t pid);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

private:
  pid_t pid_;
};

} // namespace gumshoe::models
