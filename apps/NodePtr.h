// Owning pointer to a Coin object with a reference count.
#pragma once

#include <utility>

namespace app {

/// Holds one reference to a node or path.
template <class T>
class NodePtr {
public:
    NodePtr() = default;
    explicit NodePtr(T* node) : node_(node) {
        if (node_) node_->ref();
    }
    NodePtr(const NodePtr& other) : NodePtr(other.node_) {}
    NodePtr(NodePtr&& other) noexcept : node_(std::exchange(other.node_, nullptr)) {}
    NodePtr& operator=(NodePtr other) noexcept {
        std::swap(node_, other.node_);
        return *this;
    }
    ~NodePtr() {
        if (node_) node_->unref();
    }

    T* get() const { return node_; }
    T* operator->() const { return node_; }
    explicit operator bool() const { return node_ != nullptr; }

private:
    T* node_ = nullptr;
};

}  // namespace app
