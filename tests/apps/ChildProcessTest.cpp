// Programs that are run by another, and how they end.
#include "ChildProcess.h"

#include <gtest/gtest.h>

#include <csignal>

#include "Clock.h"

namespace {

using app::ProcessEnd;
using app::runProcess;

TEST(ChildProcess, GivesBothOutputsAndTheStatus) {
    const ProcessEnd end = runProcess({"sh", "-c", "echo one; echo two >&2; exit 3"});
    EXPECT_EQ(end.out, "one\n");
    EXPECT_EQ(end.err, "two\n");
    EXPECT_EQ(end.status, 3);
    EXPECT_FALSE(end.succeeded());
    EXPECT_EQ(end.reason(), "two");
}

TEST(ChildProcess, TakesMoreThanAPipeHolds) {
    const ProcessEnd end = runProcess({"sh", "-c", "head -c 300000 /dev/zero; head -c 200000 /dev/zero >&2"});
    EXPECT_TRUE(end.succeeded());
    EXPECT_EQ(end.out.size(), 300000u);
    EXPECT_EQ(end.err.size(), 200000u);
}

TEST(ChildProcess, WorksInTheFolderThatIsAskedFor) {
    EXPECT_EQ(runProcess({"pwd"}, "/").out, "/\n");
    EXPECT_FALSE(runProcess({"pwd"}, "/no/such/folder").succeeded());
}

TEST(ChildProcess, SaysWhichSignalEndedIt) {
    const ProcessEnd end = runProcess({"sh", "-c", "kill -SEGV $$"});
    EXPECT_EQ(end.signal, SIGSEGV);
    EXPECT_FALSE(end.succeeded());
    EXPECT_NE(end.reason().find("signal 11"), std::string::npos) << end.reason();
}

TEST(ChildProcess, FailsForAProgramThatIsNotThere) {
    const ProcessEnd end = runProcess({"no-such-program-anywhere"});
    EXPECT_EQ(end.status, 127);
    EXPECT_EQ(end.reason(), "exit status 127");
}

TEST(ChildProcess, IsEndedWhenItsTimeIsOver) {
    const double start = app::nowMs();
    const ProcessEnd end = runProcess({"sleep", "30"}, {}, 0.3);
    EXPECT_TRUE(end.late);
    EXPECT_FALSE(end.succeeded());
    EXPECT_LT(app::nowMs() - start, 10000.0);
    EXPECT_EQ(end.reason(), "its time was over");
}

}  // namespace
