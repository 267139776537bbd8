// Keeps account of the GL objects that are made and deleted, by intercepting GL's own calls.
#pragma once

#include <epoxy/gl.h>

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace test {

/// While one lives, everything that goes through libepoxy is counted; so what Coin and Qt call themselves is not. Objects belong to
/// the context that is current when they are made, or to all that share() with it: but for frame buffers and vertex arrays, which
/// GL does not share.
class GlLedger {
public:
    enum Kind { Buffer, Texture, Framebuffer, Renderbuffer, VertexArray, Program, Shader, kKinds };
    using Context = const void*;
    using Counts = std::array<std::size_t, kKinds>;

    /// `current` gives the current context, or null.
    explicit GlLedger(Context (*current)()) : current_(current) {
        ledger_ = this;
        forEachHook([](auto hook) { decltype(hook)::install(); });
    }
    ~GlLedger() {
        forEachHook([](auto hook) { decltype(hook)::remove(); });
        ledger_ = nullptr;
    }
    GlLedger(const GlLedger&) = delete;
    GlLedger& operator=(const GlLedger&) = delete;

    static const char* nameOf(std::size_t kind) {
        static const char* const names[kKinds] = {"buffers",       "textures", "framebuffers", "renderbuffers",
                                                  "vertex arrays", "programs", "shaders"};
        return names[kind];
    }
    void share(Context context, Context with) {
        const int old = groupOf(context), group = groupOf(with);
        if (old == group) return;
        shared_[group].merge(shared_[old]);
        shared_.erase(old);
        groups_[context] = group;
    }
    /// The context is gone, and with the last of a group all that was in it.
    void forget(Context context) {
        const int group = groupOf(context);
        own_.erase(context);
        groups_.erase(context);
        for (const auto& [other, its] : groups_)
            if (its == group) return;
        shared_.erase(group);
    }
    /// What there is in a context now is not to be counted.
    void disregard(Context context) {
        for (auto* names : {&own_[context], &shared_[groupOf(context)]})
            for (auto& [name, counts] : *names) counts = false;
    }
    /// What lives in a context and its group.
    Counts in(Context context) {
        Counts counts{};
        add(counts, own_[context]);
        add(counts, shared_[groupOf(context)]);
        return counts;
    }
    Counts all() const {
        Counts counts{};
        for (const auto& [context, names] : own_) add(counts, names);
        for (const auto& [group, names] : shared_) add(counts, names);
        return counts;
    }
    std::size_t total() const { return sum(all()); }
    static std::size_t sum(const Counts& counts) {
        std::size_t total = 0;
        for (const std::size_t count : counts) total += count;
        return total;
    }
    static std::string text(const Counts& counts) {
        std::string text;
        for (std::size_t kind = 0; kind < kKinds; ++kind)
            if (counts[kind] > 0) text += (text.empty() ? "" : ", ") + std::to_string(counts[kind]) + ' ' + nameOf(kind);
        return text.empty() ? "none" : text;
    }
    /// How many were made so far.
    std::size_t born() const { return born_; }
    /// Deletions of what did not exist in the current context, or without any.
    const std::vector<std::string>& strays() const { return strays_; }

private:
    using Name = std::pair<int, GLuint>;
    using Names = std::map<Name, bool>;  ///< with whether it counts

    int groupOf(Context context) {
        const auto [place, isNew] = groups_.try_emplace(context, nextGroup_);
        nextGroup_ += isNew;
        return place->second;
    }
    Names& namesOf(int kind) {
        const Context context = current_();
        return kind == Framebuffer || kind == VertexArray ? own_[context] : shared_[groupOf(context)];
    }
    static void add(Counts& counts, const Names& names) {
        for (const auto& [name, isCounted] : names) counts[std::size_t(name.first)] += isCounted;
    }
    void born(int kind, GLuint name) {
        if (name) namesOf(kind)[{kind, name}] = true;
        born_ += name != 0;
    }
    void dead(int kind, GLuint name) {
        if (name && namesOf(kind).erase({kind, name}) == 0)
            strays_.push_back(std::string(nameOf(std::size_t(kind))) + ' ' + std::to_string(name));
    }

    /// Calls GL. On a function's first call libepoxy finds it, and only while it stands in its own place.
    template <auto& kPointer, class Real, class Hooked, class... Arguments>
    static auto call(Real& real, Hooked hook, Arguments... arguments) {
        struct Again {
            Real& real;
            Hooked hook;
            ~Again() {
                real = kPointer;
                kPointer = hook;
            }
        } again{real, hook};
        kPointer = real;
        return real(arguments...);
    }
    template <auto& kPointer, Kind kKind, bool kBorn>
    struct Many {
        using Pointer = std::remove_reference_t<decltype(kPointer)>;
        static inline Pointer real = nullptr;
        template <class Name>
        static void count(GLsizei n, Name* names) {
            for (GLsizei i = 0; i < n && ledger_; ++i) kBorn ? ledger_->born(kKind, names[i]) : ledger_->dead(kKind, names[i]);
        }
        static void made(GLsizei n, GLuint* names) { call<kPointer>(real, &made, n, names), count(n, names); }
        static void deleted(GLsizei n, const GLuint* names) { count(n, names), call<kPointer>(real, &deleted, n, names); }
        static void install() {
            if constexpr (kBorn)
                real = std::exchange(kPointer, &made);
            else
                real = std::exchange(kPointer, &deleted);
        }
        static void remove() { kPointer = real; }
    };
    struct NewProgram {
        static inline PFNGLCREATEPROGRAMPROC real = nullptr;
        static GLuint hook() {
            const GLuint name = call<epoxy_glCreateProgram>(real, &hook);
            if (ledger_) ledger_->born(Program, name);
            return name;
        }
        static void install() { real = std::exchange(epoxy_glCreateProgram, &hook); }
        static void remove() { epoxy_glCreateProgram = real; }
    };
    struct NewShader {
        static inline PFNGLCREATESHADERPROC real = nullptr;
        static GLuint hook(GLenum stage) {
            const GLuint name = call<epoxy_glCreateShader>(real, &hook, stage);
            if (ledger_) ledger_->born(Shader, name);
            return name;
        }
        static void install() { real = std::exchange(epoxy_glCreateShader, &hook); }
        static void remove() { epoxy_glCreateShader = real; }
    };
    template <auto& kPointer, Kind kKind>
    struct OldName {
        static inline std::remove_reference_t<decltype(kPointer)> real = nullptr;
        static void hook(GLuint name) {
            if (ledger_) ledger_->dead(kKind, name);
            call<kPointer>(real, &hook, name);
        }
        static void install() { real = std::exchange(kPointer, &hook); }
        static void remove() { kPointer = real; }
    };
    template <class Each>
    static void forEachHook(const Each& each) {
        each(Many<epoxy_glGenBuffers, Buffer, true>{}), each(Many<epoxy_glDeleteBuffers, Buffer, false>{});
        each(Many<epoxy_glGenTextures, Texture, true>{}), each(Many<epoxy_glDeleteTextures, Texture, false>{});
        each(Many<epoxy_glGenFramebuffers, Framebuffer, true>{}), each(Many<epoxy_glDeleteFramebuffers, Framebuffer, false>{});
        each(Many<epoxy_glGenRenderbuffers, Renderbuffer, true>{}), each(Many<epoxy_glDeleteRenderbuffers, Renderbuffer, false>{});
        each(Many<epoxy_glGenVertexArrays, VertexArray, true>{}), each(Many<epoxy_glDeleteVertexArrays, VertexArray, false>{});
        each(NewProgram{}), each(OldName<epoxy_glDeleteProgram, Program>{});
        each(NewShader{}), each(OldName<epoxy_glDeleteShader, Shader>{});
    }

    static inline GlLedger* ledger_ = nullptr;
    Context (*current_)();
    int nextGroup_ = 0;
    std::size_t born_ = 0;
    std::map<Context, int> groups_;
    std::map<Context, Names> own_;  ///< what GL does not share
    std::map<int, Names> shared_;   ///< by group
    std::vector<std::string> strays_;
};

}  // namespace test
