// Entry point of the SoTerrain node kit.
#ifndef SOTERRAIN_SOTERRAIN_H
#define SOTERRAIN_SOTERRAIN_H

/// Functions of the library as a whole.
class SoTerrain {
public:
    /// Registers every node, element and detail class with Coin. Call it after SoDB::init(); calling it again does nothing. A program
    /// that only reads .iv files does not need it: Coin finds each class by its name.
    static void init();
    /// "major.minor.patch" of the library that is loaded.
    static const char* getVersion();
};

extern "C" {
/// SoTerrain::init() under a C name, for bindings and dlsym().
void soterrain_init(void);
}

#endif
