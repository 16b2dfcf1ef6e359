// SPDX-License-Identifier: MIT
#include "topology/brep/step_writer.h"

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Quantity_Color.hxx>
#include <STEPConstruct.hxx>
#include <STEPConstruct_DataMapOfAsciiStringTransient.hxx>
#include <STEPConstruct_DataMapOfPointTransient.hxx>
#include <STEPConstruct_Styles.hxx>
#include <STEPControl_Writer.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepVisual_Colour.hxx>
#include <StepVisual_MechanicalDesignGeometricPresentationRepresentation.hxx>
#include <StepVisual_PresentationStyleAssignment.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <Transfer_FinderProcess.hxx>
#include <XSControl_TransferWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <filesystem>

#include "datasets/types/errors.h"
#include "sketches/io/step_file.h"

namespace sketchsplat::brep {
namespace {

namespace fs = std::filesystem;

struct Paint {
  const char* name;
  double red, green, blue;
};

// Light, so that edges are seen on them; by the families of kinds of curve in drawings.
Paint paint_of(GeomAbs_SurfaceType type) {
  switch (type) {
    case GeomAbs_Plane:
      return {"plane", 0.8, 0.8, 0.8};
    case GeomAbs_Cylinder:
      return {"cylinder", 0.55, 0.72, 0.95};
    case GeomAbs_Cone:
      return {"cone", 0.55, 0.85, 0.65};
    case GeomAbs_Sphere:
      return {"sphere", 0.97, 0.72, 0.45};
    case GeomAbs_Torus:
      return {"torus", 0.8, 0.62, 0.9};
    default:
      return {"freeform", 0.95, 0.65, 0.75};
  }
}

Handle(TCollection_HAsciiString) text_of(const std::string& text) {
  return new TCollection_HAsciiString(text.c_str());
}

// As in a string literal of the file, but for its quotes: OpenCASCADE writes backslashes as they
// are and doubles single quotes itself.
std::string encoded(const std::string& name) {
  std::string out;
  const std::string literal = step::quoted(name);
  for (size_t i = 1; i + 1 < literal.size(); ++i) {
    out += literal[i];
    if (literal[i] == '\'') ++i;
  }
  return out;
}

void paint_faces(const TopoDS_Shape& shape, const Handle(XSControl_WorkSession) & session) {
  STEPConstruct_Styles styles(session);
  STEPConstruct_DataMapOfAsciiStringTransient predefined;
  STEPConstruct_DataMapOfPointTransient colours;
  const Handle(Transfer_FinderProcess) process = session->TransferWriter()->FinderProcess();
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  for (int f = 1; f <= faces.Extent(); ++f) {
    const Handle(StepRepr_RepresentationItem) item = STEPConstruct::FindEntity(process, faces(f));
    if (item.IsNull()) continue;
    const Paint paint =
        paint_of(BRepAdaptor_Surface(TopoDS::Face(faces(f)), /*Restriction=*/false).GetType());
    item->SetName(text_of(std::string(paint.name) + "_" + std::to_string(f - 1)));
    const Quantity_Color colour(paint.red, paint.green, paint.blue, Quantity_TOC_sRGB);
    const Handle(StepVisual_Colour) step_colour = styles.EncodeColor(colour, predefined, colours);
    styles.AddStyle(item, styles.MakeColorPSA(item, step_colour, nullptr, nullptr, 0), nullptr);
  }
  const Handle(StepRepr_RepresentationContext) context = styles.FindContext(shape);
  Handle(StepVisual_MechanicalDesignGeometricPresentationRepresentation) presentation;
  if (!context.IsNull() && styles.CreateMDGPR(context, presentation))
    session->Model()->AddWithRefs(presentation);
}

void set_header(const Handle(StepData_StepModel) & model, const std::string& name) {
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text_of(name));
  header.SetTimeStamp(text_of("1970-01-01T00:00:00"));
  header.SetAuthorValue(1, text_of(""));
  header.SetOrganizationValue(1, text_of(""));
  header.SetPreprocessorVersion(text_of("sketchsplat"));
  header.SetOriginatingSystem(text_of("sketchsplat"));
  header.SetAuthorisation(text_of(""));
  header.SetDescriptionValue(1, text_of("boundary representation"));
  header.Apply(model);
}

void set_statics(const std::string& name, LengthUnit unit) {
  constexpr const char* kUnits[] = {"MM", "CM", "M", "INCH"};
  Interface_Static::SetCVal("write.step.unit", kUnits[int(unit)]);
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetCVal("write.step.product.name", name.c_str());
  Interface_Static::SetIVal("write.step.assembly", 0);
  // Readers find the curves of edges on surfaces themselves; half of the file would be these.
  Interface_Static::SetIVal("write.surfacecurve.mode", 0);
}

}  // namespace

void write_step_file(const TopoDS_Shape& shape, const std::string& name, LengthUnit unit,
                     const std::string& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  STEPControl_Writer writer;  // before the statics, which it defines
  const std::string label = encoded(name);
  set_statics(label, unit);
  if (writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone)
    throw OutputError(path, "a shape that STEP cannot hold");
  paint_faces(shape, writer.WS());
  const Handle(StepRepr_RepresentationItem) solid =
      STEPConstruct::FindEntity(writer.WS()->TransferWriter()->FinderProcess(), shape);
  if (!solid.IsNull()) solid->SetName(text_of(label));
  set_header(writer.Model(), label);
  const std::string temporary = path + ".part";
  std::error_code error;
  if (writer.Write(temporary.c_str()) != IFSelect_RetDone) {
    fs::remove(temporary, error);
    throw OutputError(path, "no way to write there");
  }
  fs::rename(temporary, path, error);
  if (error) throw OutputError(path, error.message());
}

}  // namespace sketchsplat::brep
