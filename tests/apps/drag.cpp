// A window whose only content is a file to be dragged away: drag FILE.
#include <QApplication>
#include <QDrag>
#include <QLabel>
#include <QMimeData>
#include <QUrl>

namespace {

class Source : public QLabel {
public:
    explicit Source(const QString& file) : QLabel("drag"), file_(file) {}

protected:
    void mousePressEvent(QMouseEvent*) override {
        auto* data = new QMimeData;
        data->setUrls({QUrl::fromLocalFile(file_)});
        auto* drag = new QDrag(this);
        drag->setMimeData(data);
        drag->exec(Qt::CopyAction);
    }

private:
    QString file_;
};

}  // namespace

int main(int argc, char** argv) {
    QApplication application(argc, argv);
    if (argc != 2) return 2;
    Source source(QString::fromLocal8Bit(argv[1]));
    source.setWindowTitle("drag source");
    source.setGeometry(1040, 20, 50, 50);
    source.show();
    return application.exec();
}
