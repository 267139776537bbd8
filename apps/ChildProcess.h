// Runs other programs, so that none outlives this one.
#pragma once

#include <string>
#include <vector>

namespace app {

/// How a program ended.
struct ProcessEnd {
    int status = -1;    ///< as exit() had it; -1 when it did not end by itself or could not be started
    int signal = 0;     ///< that ended it
    bool late = false;  ///< it was ended because its time was over
    std::string out;    ///< what it wrote to stdout
    std::string err;    ///< and to stderr

    bool succeeded() const { return status == 0; }
    /// Why it failed: the last line that it wrote to stderr, else how it ended.
    std::string reason() const;
};

/// Runs a program, which is looked for in PATH where its name has no slash, in this folder ("": the current one) and waits for it.
/// It is ended when `seconds` (0: any time) are over, when interrupted() becomes true, and with this process, however that ends.
ProcessEnd runProcess(const std::vector<std::string>& command, const std::string& folder = {}, double seconds = 0.0);

/// From now on SIGINT, SIGTERM and SIGHUP do not end this process, but make interrupted() true.
void catchInterrupts();
bool interrupted();

}  // namespace app
