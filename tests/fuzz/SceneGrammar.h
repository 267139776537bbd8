// Scenes as text, made and changed at random by a grammar: which nodes and fields there are, Coin tells at run time.
#pragma once

#include <random>
#include <string>
#include <vector>

class SoField;

namespace fuzz {

/// A scene is a list of blocks between `Separator {` and `}`: a node each, with a line for each of its fields. Lines that begin
/// with # are what FuzzScene does with it after the first frame: `#set CLASS.FIELD VALUE`, `#connect CLASS.FIELD CLASS.FIELD`,
/// `#view NUMBER`, `#heights COLUMN ROW COLUMNS ROWS SEED`, `#again`.
class SceneGrammar {
public:
    /// `files`: names that fields may hold. Coin and SoTerrain must have been initialised.
    explicit SceneGrammar(std::vector<std::string> files);

    std::string scene(std::mt19937& random) const;
    /// The scene with something else about it. Of a text that is no such scene a new one is made.
    std::string changed(const std::string& text, std::mt19937& random) const;
    /// Names of all node classes of SoTerrain that can be made.
    const std::vector<std::string>& classes() const { return classes_; }

private:
    using Random = std::mt19937;
    struct Parts {
        std::vector<std::string> notes, blocks;
    };
    static Parts parse(const std::string& text);
    static std::string joined(const Parts& parts);

    std::string node(const std::string& name, Random& random, int depth) const;
    std::string block(Random& random) const;
    std::string coordinates(Random& random) const;
    std::string stateNode(Random& random) const;
    std::string note(Random& random) const;
    std::string fieldName(Random& random) const;
    std::string value(const std::string& className, const std::string& field, Random& random) const;
    std::string value(SoField* field, Random& random, int depth) const;
    void changeValue(std::string& block, Random& random) const;
    void changeOnce(Parts& parts, Random& random) const;

    std::vector<std::string> files_, classes_, shapes_;
};

}  // namespace fuzz
