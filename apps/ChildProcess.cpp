#include "ChildProcess.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <cstring>

#include "Clock.h"

namespace app {

namespace {

volatile sig_atomic_t caught = 0;

// In the new process: becomes the program, its output into pipes.
[[noreturn]] void become(char* const* arguments, const char* folder, pid_t parent, int out, int err) {
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
#endif
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    if (*folder && chdir(folder) != 0) _exit(127);
    execvp(arguments[0], arguments);
    _exit(127);
}

// Takes what a pipe has; false at its end.
bool take(int file, std::string& text) {
    char buffer[4096];
    const ssize_t count = read(file, buffer, sizeof buffer);
    if (count > 0) text.append(buffer, std::size_t(count));
    return count > 0 || (count < 0 && (errno == EINTR || errno == EAGAIN));
}

// Reads both pipes until they end, or ends the process.
void follow(pid_t child, const int (&files)[2], double seconds, ProcessEnd& end) {
    constexpr int patienceMs = 100;
    const double start = nowMs();
    pollfd open[2] = {{files[0], POLLIN, 0}, {files[1], POLLIN, 0}};
    while (open[0].fd >= 0 || open[1].fd >= 0) {
        end.late = seconds > 0.0 && nowMs() - start > 1000.0 * seconds;
        if (end.late || interrupted()) {
            kill(child, SIGKILL);
            return;
        }
        if (poll(open, 2, patienceMs) <= 0) continue;
        if (open[0].revents && !take(open[0].fd, end.out)) open[0].fd = -1;
        if (open[1].revents && !take(open[1].fd, end.err)) open[1].fd = -1;
    }
}

void waitFor(pid_t child, ProcessEnd& end) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return;
    if (WIFEXITED(status)) end.status = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
}

std::string lastLine(const std::string& text) {
    const std::size_t end = text.find_last_not_of(" \n\r\t");
    if (end == std::string::npos) return {};
    const std::size_t begin = text.rfind('\n', end);
    return text.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? std::size_t(-1) : begin));
}

}  // namespace

std::string ProcessEnd::reason() const {
    if (late) return "its time was over";
    if (signal) return "ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
    const std::string said = lastLine(err);
    if (!said.empty()) return said;
    return status < 0 ? "could not be started" : "exit status " + std::to_string(status);
}

ProcessEnd runProcess(const std::vector<std::string>& command, const std::string& folder, double seconds) {
    ProcessEnd end;
    int out[2], err[2];
    if (pipe2(out, O_CLOEXEC) != 0) return end;
    if (pipe2(err, O_CLOEXEC) != 0) {
        close(out[0]);
        close(out[1]);
        return end;
    }
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t parent = getpid(), child = fork();
    if (child == 0) become(arguments.data(), folder.c_str(), parent, out[1], err[1]);
    close(out[1]);
    close(err[1]);
    if (child > 0) {
        follow(child, {out[0], err[0]}, seconds, end);
        waitFor(child, end);
    }
    close(out[0]);
    close(err[0]);
    return end;
}

void catchInterrupts() {
    struct sigaction action = {};
    action.sa_handler = [](int) { caught = 1; };
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
}

bool interrupted() {
    return caught != 0;
}

}  // namespace app
