// SPDX-License-Identifier: MIT
#include "topology/brep/step_writer.h"

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Precision.hxx>
#include <Quantity_Color.hxx>
#include <STEPConstruct.hxx>
#include <STEPConstruct_DataMapOfAsciiStringTransient.hxx>
#include <STEPConstruct_DataMapOfPointTransient.hxx>
#include <STEPConstruct_Styles.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <STEPEdit.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_ManifoldSolidBrep.hxx>
#include <StepVisual_Colour.hxx>
#include <StepVisual_MechanicalDesignGeometricPresentationRepresentation.hxx>
#include <StepVisual_PresentationStyleAssignment.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <Transfer_FinderProcess.hxx>
#include <XSControl_TransferWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "datasets/types/errors.h"
#include "sketches/io/step_file.h"
#include "topology/brep/check.h"

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

// Stands for the name until the text is there: OpenCASCADE doubles the backslashes of everything
// that is encoded, and numbers its products.
constexpr char kNameToken[] = "name_of_the_product";

void paint_faces(const TopoDS_Shape& shape, const std::vector<TopoDS_Shape>& faces,
                 const Handle(XSControl_WorkSession) & session) {
  STEPConstruct_Styles styles(session);
  STEPConstruct_DataMapOfAsciiStringTransient predefined;
  STEPConstruct_DataMapOfPointTransient colours;
  const Handle(Transfer_FinderProcess) process = session->TransferWriter()->FinderProcess();
  for (size_t f = 0; f < faces.size(); ++f) {
    const Handle(StepRepr_RepresentationItem) item = STEPConstruct::FindEntity(process, faces[f]);
    if (item.IsNull()) continue;
    const Paint paint =
        paint_of(BRepAdaptor_Surface(TopoDS::Face(faces[f]), /*Restriction=*/false).GetType());
    item->SetName(text_of(std::string(paint.name) + "_" + std::to_string(f)));
    const Quantity_Color colour(paint.red, paint.green, paint.blue, Quantity_TOC_sRGB);
    const Handle(StepVisual_Colour) step_colour = styles.EncodeColor(colour, predefined, colours);
    styles.AddStyle(item, styles.MakeColorPSA(item, step_colour, nullptr, nullptr, 0), nullptr);
  }
  const Handle(StepRepr_RepresentationContext) context = styles.FindContext(shape);
  Handle(StepVisual_MechanicalDesignGeometricPresentationRepresentation) presentation;
  if (!context.IsNull() && styles.CreateMDGPR(context, presentation))
    session->Model()->AddWithRefs(presentation);
}

void set_header(const Handle(StepData_StepModel) & model) {
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text_of(kNameToken));
  header.SetTimeStamp(text_of("1970-01-01T00:00:00"));
  header.SetAuthorValue(1, text_of(""));
  header.SetOrganizationValue(1, text_of(""));
  header.SetPreprocessorVersion(text_of("sketchsplat"));
  header.SetOriginatingSystem(text_of("sketchsplat"));
  header.SetAuthorisation(text_of(""));
  header.SetDescriptionValue(1, text_of("boundary representation"));
  header.Apply(model);
}

void set_names(const Handle(StepData_StepModel) & model) {
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    const Handle(StepBasic_Product) product = Handle(StepBasic_Product)::DownCast(entity);
    const Handle(StepShape_ManifoldSolidBrep) solid =
        Handle(StepShape_ManifoldSolidBrep)::DownCast(entity);
    if (!product.IsNull()) {
      product->SetId(text_of(kNameToken));
      product->SetName(text_of(kNameToken));
    }
    if (!solid.IsNull()) solid->SetName(text_of(kNameToken));
  }
}

// Readers take what is nearer than the stated uncertainty for one.
double uncertainty_of(const TopoDS_Shape& shape) {
  return std::max(Precision::Confusion(), tolerance_of(shape));
}

void set_statics(LengthUnit unit) {
  constexpr const char* kUnits[] = {"MM", "CM", "M", "INCH"};
  Interface_Static::SetCVal("write.step.unit", kUnits[int(unit)]);
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Interface_Static::SetIVal("write.step.assembly", 0);
  // Readers find the curves of edges on surfaces themselves; half of the file would be these.
  Interface_Static::SetIVal("write.surfacecurve.mode", 0);
}

std::string text_of(const Handle(StepData_StepModel) & model, const std::string& name) {
  StepData_StepWriter writer(model);
  writer.SendModel(Handle(StepData_Protocol)::DownCast(STEPEdit::Protocol()));
  std::ostringstream out;
  writer.Print(out);
  std::string text = out.str();
  const std::string token = std::string("'") + kNameToken + "'", literal = step::quoted(name);
  for (size_t at = text.find(token); at != std::string::npos;
       at = text.find(token, at + literal.size()))
    text.replace(at, token.size(), literal);
  return text;
}

void write_text(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".part";
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  std::error_code error;
  if (!out) {
    fs::remove(temporary, error);
    throw OutputError(path, "no way to write there");
  }
  fs::rename(temporary, path, error);
  if (error) throw OutputError(path, error.message());
}

}  // namespace

void write_step_file(const TopoDS_Shape& shape, const std::string& name, LengthUnit unit,
                     const std::string& path, std::vector<TopoDS_Shape> faces) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  STEPControl_Controller::Init();  // defines what is set here, and writers look at when made
  set_statics(unit);
  STEPControl_Writer writer;
  writer.SetTolerance(uncertainty_of(shape));
  if (writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone)
    throw OutputError(path, "a shape that STEP cannot hold");
  if (faces.empty())
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
      faces.push_back(it.Current());
  paint_faces(shape, faces, writer.WS());
  set_names(writer.Model());
  set_header(writer.Model());
  write_text(path, text_of(writer.Model(), name));
}

}  // namespace sketchsplat::brep
