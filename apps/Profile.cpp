#include "Profile.h"

#include <locale>

namespace app {

terrain::Result<ProfileWriter> ProfileWriter::open(const std::string& path, Rows rows) {
    ProfileWriter writer;
    writer.file_.open(path, std::ios::trunc);
    if (!writer.file_) return terrain::Error{path, "a file that can be written", "no permission, or no such folder"};
    writer.file_.imbue(std::locale::classic());
    writer.file_ << "frame,time_ms,frame_ms,select_ms,upload_ms,draw_ms,triangles,patches,error_px,resident_bytes";
    writer.file_ << (rows == Rows::Means ? ",frame_ms_min,frame_ms_max,cpu_ms\n" : "\n");
    return writer;
}

void ProfileWriter::writeCells(const FrameFigures& f) {
    file_ << f.frame << ',' << f.timeMs << ',' << f.frameMs << ',';
    if (f.terrain)
        file_ << f.terrain->selectMs << ',' << f.terrain->uploadMs << ',' << f.terrain->drawMs << ',';
    else
        file_ << ",,,";
    file_ << f.triangles << ',';
    if (f.terrain)
        file_ << f.terrain->patches << ',' << f.terrain->errorPixels << ',' << f.terrain->memoryBytes + f.terrain->bufferBytes;
    else
        file_ << ",,";
}

void ProfileWriter::write(const FrameFigures& figures) {
    writeCells(figures);
    file_ << '\n';
}

void ProfileWriter::write(const MeanFrame& frame) {
    writeCells(frame.mean);
    file_ << ',' << frame.leastMs << ',' << frame.mostMs << ',' << frame.mean.cpuMs << '\n';
}

bool ProfileWriter::close() {
    file_.close();
    return !file_.fail();
}

}  // namespace app
