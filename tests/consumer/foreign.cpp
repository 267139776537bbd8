// A program that knows Coin only: it reads a scene, and finds nodes of the classes named on the command line and their bounding box.
#include <cstdio>

#include <Inventor/SoDB.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/actions/SoGetBoundingBoxAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/nodes/SoSeparator.h>

int main(int argc, char** argv) {
    SoDB::init();
    SoInteraction::init();
    SoInput input;
    SoSeparator* root = argc > 1 && input.openFile(argv[1]) ? SoDB::readAll(&input) : nullptr;
    if (!root) return 1;
    root->ref();
    int missing = 0;
    for (int i = 2; i < argc; ++i) {
        const SoType type = SoType::fromName(argv[i]);
        SoSearchAction search;
        search.setType(type);
        search.setSearchingAll(TRUE);
        if (!type.isBad()) search.apply(root);
        if (type.isBad() || !search.getPath()) {
            std::printf("no %s in the scene\n", argv[i]);
            ++missing;
        }
    }
    SoGetBoundingBoxAction box(SbViewportRegion(64, 64));
    box.apply(root);
    const SbVec3f size = box.getBoundingBox().getSize();
    if (size != SbVec3f(2.0f, 2.0f, 4.0f)) {
        std::printf("expected a bounding box of 2 x 2 x 4, got %g x %g x %g\n", size[0], size[1], size[2]);
        ++missing;
    }
    root->unref();
    return missing ? 1 : 0;
}
