// Files of SoHeightMap nodes that somebody else reads.
#pragma once

#include <memory>
#include <string>

#include "height/HeightSource.h"

class SoHeightMap;

/// For programs that read a node's file in a thread of their own, or have read it already: decoding is the longest part of a start.
class HeightMapReading {
public:
    struct File {
        std::string path;  ///< empty: the node names none
        terrain::HeightFileOptions options;
    };
    /// What the fields name, to be read without any scale.
    static File file(SoHeightMap * map);
    /// Takes the place of reading that file once. The node makes a copy of the samples in its own scale, unless that would round them:
    /// then it reads the file. To be called after the fields are set and before they are used.
    static void give(SoHeightMap * map, std::shared_ptr<const terrain::HeightSource> source);
};
