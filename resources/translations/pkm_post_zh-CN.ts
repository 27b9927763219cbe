<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="zh_CN" sourcelanguage="en">
<context>
    <name>App::Property</name>
    <message>
        <source>The operation that this one is made from</source>
        <translation>本操作由此操作生成</translation>
    </message>
    <message>
        <source>Switch this off to leave the operation out of the program</source>
        <translation>关闭后，程序中不包含此操作</translation>
    </message>
    <message>
        <source>Name of a machine that comes with PKM Post, or path of a machine file</source>
        <translation>PKM Post 自带机床的名称，或机床文件的路径</translation>
    </message>
    <message>
        <source>CAM job whose work offset is taken</source>
        <translation>从此 CAM 作业取得工件偏置</translation>
    </message>
    <message>
        <source>Object of the model that the work offset places, if there is no job; the origin of the document if there is none</source>
        <translation>没有作业时，由工件偏置定位的模型对象；若也没有该对象，则为文档原点</translation>
    </message>
    <message>
        <source>Pose of the work frame on the table, in the machine frame</source>
        <translation>工件坐标系在工作台上的位姿，以机床坐标系表示</translation>
    </message>
    <message>
        <source>Tool tip in the work frame</source>
        <translation>刀尖在工件坐标系中的位置</translation>
    </message>
    <message>
        <source>From the tip towards the spindle, in the work frame</source>
        <translation>从刀尖指向主轴的方向，以工件坐标系表示</translation>
    </message>
    <message>
        <source>Turn of the platform about the tool axis</source>
        <translation>动平台绕刀轴的转角</translation>
    </message>
    <message>
        <source>Gauge length, from the spindle nose to the tip</source>
        <translation>刀具长度，从主轴端面到刀尖</translation>
    </message>
    <message>
        <source>Diameter of the cutter that is drawn</source>
        <translation>所显示刀具的直径</translation>
    </message>
    <message>
        <source>Its corner radius: half the diameter for a ball</source>
        <translation>刀具圆角半径：球头刀为直径的一半</translation>
    </message>
    <message>
        <source>Length that the controller counts</source>
        <translation>控制器计数的杆长</translation>
    </message>
    <message>
        <source>Smallest margin of a strut to an end of its stroke</source>
        <translation>最接近行程端点的支链的剩余行程</translation>
    </message>
    <message>
        <source>Smallest margin of a joint to its cone</source>
        <translation>最接近锥角极限的铰链的剩余摆角</translation>
    </message>
    <message>
        <source>Smallest singular value above the least allowed</source>
        <translation>最小奇异值超出允许下限的量</translation>
    </message>
    <message>
        <source>Limits that are violated at this pose</source>
        <translation>此位姿下超出极限的项目</translation>
    </message>
    <message>
        <source>Where the machine frame is in the document</source>
        <translation>机床坐标系在文档中的位置</translation>
    </message>
    <message>
        <source>The model of the job, whose faces are touched</source>
        <translation>作业的模型，刀具与其面接触</translation>
    </message>
    <message>
        <source>The faces that may be touched; all of the model if empty</source>
        <translation>允许接触的面；为空时为模型的所有面</translation>
    </message>
    <message>
        <source>Largest distance of a point from the face it touches</source>
        <translation>接触点与所接触的面之间允许的最大距离</translation>
    </message>
    <message>
        <source>Largest deviation of the tool from the surface between two points</source>
        <translation>两点之间刀具允许的最大偏差</translation>
    </message>
    <message>
        <source>Stock left on the faces, along the normal</source>
        <translation>沿法向留在面上的余量</translation>
    </message>
    <message>
        <source>Length of feed moves off the faces before and after a cut</source>
        <translation>切削前后离开面的进给移动的长度</translation>
    </message>
    <message>
        <source>Where the tool axis comes from</source>
        <translation>刀轴方向的来源</translation>
    </message>
    <message>
        <source>Lean from the normal forward, in the direction of feed</source>
        <translation>刀轴相对法线沿进给方向的前倾角</translation>
    </message>
    <message>
        <source>Lean from the normal to the left of the direction of feed</source>
        <translation>刀轴相对法线向进给方向左侧的侧倾角</translation>
    </message>
    <message>
        <source>The part program, G-code or CL data</source>
        <translation>零件程序，G 代码或刀位文件</translation>
    </message>
    <message>
        <source>Notation of the tool axis in G-code</source>
        <translation>G 代码中刀轴的表示方式</translation>
    </message>
    <message>
        <source>Whose G-code the part program is</source>
        <translation>零件程序所用 G 代码的方言</translation>
    </message>
    <message>
        <source>The unit of dwells of G-code</source>
        <translation>G 代码中暂停时间的单位</translation>
    </message>
    <message>
        <source>X, Y and Z in mm where G53 X0 Y0 Z0, G28 and G30 bring the tool tip</source>
        <translation>G53 X0 Y0 Z0、G28 和 G30 使刀尖到达的 X、Y、Z（mm）</translation>
    </message>
    <message>
        <source>Codes of G-code to leave out where they are not known, such as M21</source>
        <translation>不认识时略去的 G 代码，例如 M21</translation>
    </message>
    <message>
        <source>Origins of work offsets of G-code, as in G55=100,0,0 with mm and degrees</source>
        <translation>G 代码工件偏置的原点,例如 G55=100,0,0,单位为毫米和度</translation>
    </message>
    <message>
        <source>Folders with the files of subprograms, before that of the part program</source>
        <translation>子程序文件所在的文件夹,先于零件程序的文件夹查找</translation>
    </message>
    <message>
        <source>Whether what stands behind / in blocks of G-code is left out</source>
        <translation>是否略去 G 代码程序段中 / 之后的内容</translation>
    </message>
    <message>
        <source>Feed of cutting moves before the first one of the file, mm/min; 0 for none</source>
        <translation>文件给出第一个进给之前切削移动的进给,毫米/分钟;0 表示没有</translation>
    </message>
    <message>
        <source>What the values of GOTO statements of CL data are, as in x,y,z,i,j,k</source>
        <translation>CL 数据 GOTO 语句中各数值的含义,例如 x,y,z,i,j,k</translation>
    </message>
    <message>
        <source>File with the tools of the part program, as in tools.tbl,mm</source>
        <translation>零件程序的刀具文件,例如 tools.tbl,mm</translation>
    </message>
    <message>
        <source>What kinds of CYCLE statements of CL data do, as in BORE=ream,DEEPHL=deep</source>
        <translation>CL 数据 CYCLE 语句各类型的动作,例如 BORE=ream,DEEPHL=deep</translation>
    </message>
    <message>
        <source>Unit of length of the part program</source>
        <translation>零件程序的长度单位</translation>
    </message>
    <message>
        <source>What the points of CL data under CUTCOM are: tool centre or part contour</source>
        <translation>刀位文件中 CUTCOM 下的点是刀具中心还是零件轮廓</translation>
    </message>
    <message>
        <source>The CAM system that wrote the CL data</source>
        <translation>生成刀位文件的 CAM 系统</translation>
    </message>
    <message>
        <source>What the numbers of a CYCLE statement are where they have no words</source>
        <translation>CYCLE 语句中没有关键字的数值的含义</translation>
    </message>
    <message>
        <source>Whether the part program may have no end, such as M2 or FINI</source>
        <translation>零件程序是否可以没有结束语句（如 M2 或 FINI）</translation>
    </message>
    <message>
        <source>Diagnostics from reading the file</source>
        <translation>读取文件时发现的问题</translation>
    </message>
    <message>
        <source>The CAM job that is checked</source>
        <translation>被检查的 CAM 作业</translation>
    </message>
    <message>
        <source>The machine in the document; that of the job&apos;s arguments if there is none</source>
        <translation>文档中的机床；没有时取作业参数中的机床</translation>
    </message>
    <message>
        <source>Switch this off to check no more when the job changes</source>
        <translation>关闭后，作业更改时不再检查</translation>
    </message>
    <message>
        <source>The check whose margins colour the path</source>
        <translation>按此检查项为轨迹着色</translation>
    </message>
    <message>
        <source>Whether the machine can follow; where it is slower, it can</source>
        <translation>机床能否跟随；仅是速度较慢时视为能够跟随</translation>
    </message>
    <message>
        <source>The checks; the lists below have an entry for each</source>
        <translation>检查项；下面的列表与其逐项对应</translation>
    </message>
    <message>
        <source>Of the margins</source>
        <translation>余量的单位</translation>
    </message>
    <message>
        <source>Least margin; negative is out of limits</source>
        <translation>最小余量；负值表示超出极限</translation>
    </message>
    <message>
        <source>Margins proven between the points as well</source>
        <translation>点与点之间也已证明的余量</translation>
    </message>
    <message>
        <source>Part of the machine with the smallest margin</source>
        <translation>余量最小的部件</translation>
    </message>
    <message>
        <source>Operation in which that is</source>
        <translation>其所在的操作</translation>
    </message>
    <message>
        <source>Number of the command in the operation</source>
        <translation>操作中命令的序号</translation>
    </message>
    <message>
        <source>Where the tool tip is then</source>
        <translation>此时刀尖的位置</translation>
    </message>
    <message>
        <source>Operation of each violation</source>
        <translation>每个越限所在的操作</translation>
    </message>
    <message>
        <source>Violated limits and collisions, the worst of each operation</source>
        <translation>越限与碰撞，每个操作中最严重的</translation>
    </message>
    <message>
        <source>The report for people</source>
        <translation>供阅读的报告</translation>
    </message>
    <message>
        <source>The path of the tool tip</source>
        <translation>刀尖轨迹</translation>
    </message>
    <message>
        <source>Margin at each point, of the check that it is coloured by</source>
        <translation>着色所用检查项在每一点的余量</translation>
    </message>
    <message>
        <source>The CAM job that is simulated</source>
        <translation>被仿真的 CAM 作业</translation>
    </message>
    <message>
        <source>Switch this off to plan no more when the job changes</source>
        <translation>关闭后，作业更改时不再规划</translation>
    </message>
    <message>
        <source>Time in which the struts move</source>
        <translation>支链运动的时间</translation>
    </message>
    <message>
        <source>Time of the dwells in addition; stops and tool changes do not count</source>
        <translation>此外程序等待的时间；停止和换刀不计入</translation>
    </message>
    <message>
        <source>Motions of the program</source>
        <translation>程序的运动段数</translation>
    </message>
    <message>
        <source>Knots in time that the controller would get</source>
        <translation>控制器将得到的时间节点数</translation>
    </message>
    <message>
        <source>Length of the path of the tool tip, with rapid moves</source>
        <translation>刀尖轨迹的长度，包括快速移动</translation>
    </message>
    <message>
        <source>Least length that a strut has</source>
        <translation>支链的最小杆长</translation>
    </message>
    <message>
        <source>Greatest length that a strut has</source>
        <translation>支链的最大杆长</translation>
    </message>
    <message>
        <source>Greatest speed of a strut, in either direction</source>
        <translation>支链的最大速度，不分方向</translation>
    </message>
    <message>
        <source>Number of the strut that has it</source>
        <translation>达到该速度的支链编号</translation>
    </message>
    <message>
        <source>The operations; the list below has an entry for each</source>
        <translation>各操作；下面的列表与其逐项对应</translation>
    </message>
    <message>
        <source>Duration of each with its dwells, in s</source>
        <translation>每个操作的用时，包括暂停，单位 s</translation>
    </message>
    <message>
        <source>How many there are; the first 1000 are in the lists</source>
        <translation>问题的数量；列表中为前 1000 个</translation>
    </message>
    <message>
        <source>When each begins, in s</source>
        <translation>每个问题开始的时刻，单位 s</translation>
    </message>
    <message>
        <source>When each is worst, in s</source>
        <translation>每个问题最严重的时刻，单位 s</translation>
    </message>
    <message>
        <source>Stretches that the machine cannot follow, by time</source>
        <translation>机床不能跟随之处，按时间排列</translation>
    </message>
    <message>
        <source>Lines that the passes follow</source>
        <translation>走刀所沿的方向</translation>
    </message>
    <message>
        <source>Order of the passes</source>
        <translation>各次走刀的先后方式</translation>
    </message>
    <message>
        <source>Normal of the parallel planes</source>
        <translation>平行平面的法线</translation>
    </message>
    <message>
        <source>Begin at the other side of the face</source>
        <translation>从面的另一侧开始</translation>
    </message>
    <message>
        <source>Where the material is; in a zigzag on its first pass</source>
        <translation>材料所在的一侧；往复走刀时以第一次走刀为准</translation>
    </message>
    <message>
        <source>The material is on the other side of the faces</source>
        <translation>材料在面的另一侧</translation>
    </message>
    <message>
        <source>Whether distance or scallop height sets the stepover</source>
        <translation>行距的确定方式</translation>
    </message>
    <message>
        <source>Largest distance of passes along the surface</source>
        <translation>沿曲面的最大行距</translation>
    </message>
    <message>
        <source>Largest scallop height between passes</source>
        <translation>两次走刀之间的最大残留高度</translation>
    </message>
    <message>
        <source>Largest deviation of the cutter from the surface on straight moves</source>
        <translation>直线移动时刀具偏离曲面的最大允许量</translation>
    </message>
    <message>
        <source>Largest deviation of the tool axis between two points</source>
        <translation>两点之间刀轴允许的最大偏差</translation>
    </message>
    <message>
        <source>Middle of the cone in which the tool axis stays</source>
        <translation>限制刀轴的圆锥的轴线</translation>
    </message>
    <message>
        <source>Half angle of that cone; 180 degrees for no limit</source>
        <translation>该圆锥的半角；180 度表示无限制</translation>
    </message>
    <message>
        <source>Name or file of a machine whose reach limits the tilt from upright</source>
        <translation>机床的名称或文件，其可达性限制刀轴相对竖直方向的倾角</translation>
    </message>
    <message>
        <source>Where rapid motion ends, along the tool axis</source>
        <translation>快速移动结束处沿刀轴的距离</translation>
    </message>
    <message>
        <source>Form of lead-in and lead-out</source>
        <translation>刀具进入和离开曲面的方式</translation>
    </message>
    <message>
        <source>Length of a straight lead, radius of an arc</source>
        <translation>直线进退刀的长度，或圆弧进退刀的半径</translation>
    </message>
    <message>
        <source>Distance of the points of the model at which gouges and material left are measured; 0 to measure nothing</source>
        <translation>模型上测量过切和残留材料的点的间距；0 表示不测量</translation>
    </message>
    <message>
        <source>Number of passes</source>
        <translation>走刀次数</translation>
    </message>
    <message>
        <source>Points at which the tool axis was moved into its cone</source>
        <translation>刀轴被移入圆锥内的点数</translation>
    </message>
    <message>
        <source>Deepest cut into the model found at points CheckSpacing apart, mm; deeper between them may be missed; -1 if not measured</source>
        <translation>在间距为 CheckSpacing 的各点上测得的最大过切深度，mm；点与点之间可能更深而未被发现；未测量时为 -1</translation>
    </message>
    <message>
        <source>Where that is</source>
        <translation>其位置</translation>
    </message>
    <message>
        <source>Most material left found at points CheckSpacing apart, mm; more between them may be missed; -1 if not measured</source>
        <translation>在间距为 CheckSpacing 的各点上测得的最多残留材料，mm；点与点之间可能更多而未被发现；未测量时为 -1</translation>
    </message>
    <message>
        <source>Half angle of the cone that was used, limited by the machine</source>
        <translation>考虑机床允许范围后圆锥的半角</translation>
    </message>
    <message>
        <source>Side of the material along the path of the original, where its properties do not state it</source>
        <translation>沿原操作的走刀方向看材料所在的一侧，用于原操作未说明时</translation>
    </message>
    <message>
        <source>A point of the plane of the mirror</source>
        <translation>镜像平面上的一点</translation>
    </message>
    <message>
        <source>Normal of the plane of the mirror</source>
        <translation>镜像平面的法线</translation>
    </message>
    <message>
        <source>A flat face or datum plane that gives point and normal</source>
        <translation>给出点和法线的平面或基准平面</translation>
    </message>
    <message>
        <source>Reverse each pass, to keep climb milling</source>
        <translation>每次走刀反向，使顺铣保持为顺铣</translation>
    </message>
    <message>
        <source>A point of the axis</source>
        <translation>轴线上的一点</translation>
    </message>
    <message>
        <source>Direction of the axis</source>
        <translation>轴线的方向</translation>
    </message>
    <message>
        <source>An edge, round face or datum line that gives point and direction</source>
        <translation>给出点和方向的边、回转面或基准线</translation>
    </message>
    <message>
        <source>Angle of the turn, right-handed about the axis</source>
        <translation>旋转角度，绕轴线按右手法则</translation>
    </message>
    <message>
        <source>Number of copies, each turned by Angle against the one before</source>
        <translation>副本数，每个副本相对前一个旋转一个“Angle”</translation>
    </message>
    <message>
        <source>Angles of the copies in degrees, instead of the two</source>
        <translation>各副本的角度，单位度，代替以上两项</translation>
    </message>
    <message>
        <source>How the original cuts: Climb, Conventional, Both or Unknown</source>
        <translation>原操作的铣削方式：Climb（顺铣）、Conventional（逆铣）、Both（两者）或 Unknown（未知）</translation>
    </message>
    <message>
        <source>How the copies cut</source>
        <translation>副本的铣削方式</translation>
    </message>
    <message>
        <source>Number of places where the original and its copies meet</source>
        <translation>原操作与副本相接的处数</translation>
    </message>
    <message>
        <source>Largest distance of the tips where they meet</source>
        <translation>相接处刀尖的最大距离</translation>
    </message>
    <message>
        <source>Largest angle of the tool axes where they meet</source>
        <translation>相接处刀轴的最大夹角</translation>
    </message>
    <message>
        <source>Number of reversed passes</source>
        <translation>反向走刀的次数</translation>
    </message>
    <message>
        <source>Number of arcs with reversed sense, G2 for G3 or G3 for G2</source>
        <translation>反向的圆弧数，G2 变为 G3 或 G3 变为 G2</translation>
    </message>
    <message>
        <source>Distance between the cuts of the original and of the copy</source>
        <translation>原操作与副本切削区域之间的距离</translation>
    </message>
    <message>
        <source>Width in which the original and the copy both cut</source>
        <translation>原操作与副本都切削的宽度</translation>
    </message>
    <message>
        <source>Angle in which the original and its copies cut</source>
        <translation>原操作与副本切削的角度范围</translation>
    </message>
    <message>
        <source>Angle in which two of them or more cut</source>
        <translation>两个或更多重复切削的角度范围</translation>
    </message>
    <message>
        <source>Widest angle in which none of them cuts</source>
        <translation>均未切削的最大角度范围</translation>
    </message>
    <message>
        <source>Whether they cover the full circle without overlap</source>
        <translation>是否布满整周且互不重叠</translation>
    </message>
    <message>
        <source>Distance from the spindle nose to the tip of the tool</source>
        <translation>从主轴端面到刀尖的距离</translation>
    </message>
</context>
<context>
    <name>ContextMenu</name>
    <message>
        <source>Active</source>
        <translation>启用</translation>
    </message>
    <message>
        <source>Switch on or off</source>
        <translation>启用或停用</translation>
    </message>
</context>
<context>
    <name>ControlPanel</name>
    <message>
        <source>Gauge length of the tool in the spindle</source>
        <translation>主轴中刀具的长度，从主轴端面到刀尖</translation>
    </message>
    <message>
        <source>Connect</source>
        <translation>连接</translation>
    </message>
    <message>
        <source>Connect to the machine</source>
        <translation>连接机床</translation>
    </message>
    <message>
        <source>Simulated machine</source>
        <translation>模拟机床</translation>
    </message>
    <message>
        <source>Operate a simulated machine, to train; nothing real moves</source>
        <translation>操作模拟机床，供练习；没有真实部件运动</translation>
    </message>
    <message>
        <source>Disconnect</source>
        <translation>断开</translation>
    </message>
    <message>
        <source>End the connection; the controller goes on with what it does</source>
        <translation>结束连接；控制器继续执行正在进行的动作</translation>
    </message>
    <message>
        <source>Port</source>
        <translation>端口</translation>
    </message>
    <message>
        <source>Machine</source>
        <translation>机床</translation>
    </message>
    <message>
        <source>Tool length</source>
        <translation>刀具长度</translation>
    </message>
    <message>
        <source>The length of the tool has to be above zero</source>
        <translation>刀具长度必须大于零</translation>
    </message>
    <message>
        <source>Machine file</source>
        <translation>机床文件</translation>
    </message>
    <message>
        <source>Machine files</source>
        <translation>机床文件</translation>
    </message>
    <message>
        <source>Program {}: {} lines, listed back as sent</source>
        <translation>程序 {}：{} 行，回读与发送内容一致</translation>
    </message>
    <message>
        <source>An error of this program ended the connection. THE MACHINE GOES ON.</source>
        <translation>本软件出错，连接已中断。机床仍在继续运行。</translation>
    </message>
    <message>
        <source>Not carried out: a stop came first</source>
        <translation>未执行：已先发出停止指令</translation>
    </message>
    <message>
        <source>Numerical control</source>
        <translation>数控面板</translation>
    </message>
    <message>
        <source>The machine moves, or may move. What is to become of it?</source>
        <translation>机床正在运动或可能运动。如何处理？</translation>
    </message>
    <message>
        <source>Hold it, then close</source>
        <translation>进给保持，然后关闭</translation>
    </message>
    <message>
        <source>Close; the machine goes on</source>
        <translation>关闭；机床继续运行</translation>
    </message>
    <message>
        <source>The machine of the document follows</source>
        <translation>文档中的机床跟随运动</translation>
    </message>
    <message>
        <source>Connection</source>
        <translation>连接</translation>
    </message>
    <message>
        <source>Homing</source>
        <translation>回零</translation>
    </message>
    <message>
        <source>Jog</source>
        <translation>点动</translation>
    </message>
    <message>
        <source>MDI</source>
        <translation>MDI</translation>
    </message>
    <message>
        <source>Program</source>
        <translation>程序</translation>
    </message>
    <message>
        <source>Play</source>
        <translation>播放</translation>
    </message>
    <message>
        <source>Not connected</source>
        <translation>未连接</translation>
    </message>
    <message>
        <source>No link: {}</source>
        <translation>无连接：{}</translation>
    </message>
    <message>
        <source>One moment: connecting, leaving or reading</source>
        <translation>请稍候：正在连接、断开或读取</translation>
    </message>
    <message>
        <source>SIMULATED MACHINE: for training. Nothing real moves.</source>
        <translation>模拟机床：仅供练习。没有真实部件运动。</translation>
    </message>
    <message>
        <source>The active document has no machine object of this machine that is free</source>
        <translation>活动文档中没有空闲的该机床对象</translation>
    </message>
    <message>
        <source>Home</source>
        <translation>回零</translation>
    </message>
    <message>
        <source>Start the homing of the machine, and watch it</source>
        <translation>启动机床回零，并监视其过程</translation>
    </message>
    <message>
        <source>Line that starts the homing of this machine, as its builder says, such as ENABLE PLC 3</source>
        <translation>启动本机床回零的命令行，由机床制造商给出，例如 ENABLE PLC 3</translation>
    </message>
    <message>
        <source>The machine moves by itself now, and Hold does not stop it: have the emergency stop at hand.
Is the way of all struts, of the platform and of the tool free?</source>
        <translation>机床即将自行运动，“进给保持”不能使其停止：请将手放在急停按钮旁。
所有支链、动平台和刀具的运动路径是否畅通无阻？</translation>
    </message>
    <message>
        <source>Home the machine</source>
        <translation>机床回零</translation>
    </message>
    <message>
        <source>X</source>
        <translation>X</translation>
    </message>
    <message>
        <source>The tip along X of the machine</source>
        <translation>刀尖沿机床 X 轴移动</translation>
    </message>
    <message>
        <source>Y</source>
        <translation>Y</translation>
    </message>
    <message>
        <source>The tip along Y of the machine</source>
        <translation>刀尖沿机床 Y 轴移动</translation>
    </message>
    <message>
        <source>Z</source>
        <translation>Z</translation>
    </message>
    <message>
        <source>The tip along Z of the machine</source>
        <translation>刀尖沿机床 Z 轴移动</translation>
    </message>
    <message>
        <source>Tilt X</source>
        <translation>绕 X 倾斜</translation>
    </message>
    <message>
        <source>The tool axis about X of the machine; the tip stands</source>
        <translation>刀轴绕机床 X 轴转动；刀尖不动</translation>
    </message>
    <message>
        <source>Tilt Y</source>
        <translation>绕 Y 倾斜</translation>
    </message>
    <message>
        <source>The tool axis about Y of the machine; the tip stands</source>
        <translation>刀轴绕机床 Y 轴转动；刀尖不动</translation>
    </message>
    <message>
        <source>Spin</source>
        <translation>自转角</translation>
    </message>
    <message>
        <source>The platform about the tool axis; the tip stands</source>
        <translation>动平台绕刀轴转动；刀尖不动</translation>
    </message>
    <message>
        <source>Step</source>
        <translation>步长</translation>
    </message>
    <message>
        <source>Turn</source>
        <translation>转角</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>速度</translation>
    </message>
    <message>
        <source>Turning</source>
        <translation>转速</translation>
    </message>
    <message>
        <source>Strut</source>
        <translation>支链</translation>
    </message>
    <message>
        <source>One strut alone; it takes the platform with it</source>
        <translation>仅一条支链；动平台随之运动</translation>
    </message>
    <message>
        <source>Not sent: the speed has to be above zero</source>
        <translation>未发送：速度必须大于零</translation>
    </message>
    <message>
        <source>Not sent: the jog is refused</source>
        <translation>未发送：点动被拒绝</translation>
    </message>
    <message>
        <source>How the line says the tool axis; none leaves it as it is</source>
        <translation>该行中刀轴的表示方式；none 表示保持不变</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>检查</translation>
    </message>
    <message>
        <source>Plan the line, and send nothing</source>
        <translation>规划该行，不发送任何内容</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>执行</translation>
    </message>
    <message>
        <source>Plan the line and, if nothing stands against it, carry it out</source>
        <translation>规划该行，如无问题则执行</translation>
    </message>
    <message>
        <source>Refused; nothing was sent</source>
        <translation>已拒绝；未发送任何内容</translation>
    </message>
    <message>
        <source>To {}, axis {}, spin {} in the machine frame; {:.1f} s</source>
        <translation>至 {}，刀轴 {}，自转角 {}（机床坐标系）；{:.1f} s</translation>
    </message>
    <message>
        <source>Approach first</source>
        <translation>先接近</translation>
    </message>
    <message>
        <source>Single block</source>
        <translation>单段</translation>
    </message>
    <message>
        <source>Stop at M1</source>
        <translation>在 M1 处停止</translation>
    </message>
    <message>
        <source>Dry run at</source>
        <translation>空运行速度</translation>
    </message>
    <message>
        <source>Bring the tool to the beginning; to a line always</source>
        <translation>将刀具移到起点；从某一行开始时总是如此</translation>
    </message>
    <message>
        <source>Rest at the end of each line, until Go on</source>
        <translation>在每一行末尾停下，直到按“继续”</translation>
    </message>
    <message>
        <source>This feed for all moves but rapid ones, without spindle, coolant and dwells</source>
        <translation>除快速移动外所有移动都用此进给速度，不启动主轴和冷却，不暂停</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>打开</translation>
    </message>
    <message>
        <source>Open a trajectory that was posted</source>
        <translation>打开后处理得到的轨迹</translation>
    </message>
    <message>
        <source>Play it from the line on</source>
        <translation>从该行开始播放</translation>
    </message>
    <message>
        <source>Go on</source>
        <translation>继续</translation>
    </message>
    <message>
        <source>Go on after a stop, a block, a tool or an override of 0</source>
        <translation>在停止、单段、换刀或倍率为 0 之后继续</translation>
    </message>
    <message>
        <source>End</source>
        <translation>结束</translation>
    </message>
    <message>
        <source>End it at the next stop on the path</source>
        <translation>在路径上的下一个停止点结束</translation>
    </message>
    <message>
        <source>the beginning</source>
        <translation>开头</translation>
    </message>
    <message>
        <source>Feed along the path; rapid moves are not faster than at 100 %</source>
        <translation>沿路径的进给；快速移动不会快于 100 % 时的速度</translation>
    </message>
    <message>
        <source>Begin at line</source>
        <translation>起始行</translation>
    </message>
    <message>
        <source>Feed</source>
        <translation>进给</translation>
    </message>
    <message>
        <source>no trajectory was opened</source>
        <translation>没有打开轨迹</translation>
    </message>
    <message>
        <source>Open a trajectory</source>
        <translation>打开轨迹</translation>
    </message>
    <message>
        <source>Trajectories</source>
        <translation>轨迹</translation>
    </message>
    <message>
        <source>of any operation</source>
        <translation>任意工序</translation>
    </message>
    <message>
        <source>Open a motion program</source>
        <translation>打开运动程序</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>取消</translation>
    </message>
    <message>
        <source>Stop loading</source>
        <translation>停止下载</translation>
    </message>
    <message>
        <source>Load</source>
        <translation>下载</translation>
    </message>
    <message>
        <source>Load it, list it back and compare</source>
        <translation>下载到控制器，回读并比较</translation>
    </message>
    <message>
        <source>Approach</source>
        <translation>接近起点</translation>
    </message>
    <message>
        <source>Bring the tool to the start of the program, planned and checked</source>
        <translation>将刀具移到程序起点，路径经过规划和检查</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>启动</translation>
    </message>
    <message>
        <source>Start it from its beginning</source>
        <translation>从头启动程序</translation>
    </message>
    <message>
        <source>Begin at block</source>
        <translation>起始程序段</translation>
    </message>
    <message>
        <source>Take it for single block</source>
        <translation>以此用于单段执行</translation>
    </message>
    <message>
        <source>Next block</source>
        <translation>下一程序段</translation>
    </message>
    <message>
        <source>Run the next line of its source, to rest</source>
        <translation>运行源程序的下一行，直到静止</translation>
    </message>
    <message>
        <source>Not sent: the block is refused</source>
        <translation>未发送：该程序段被拒绝</translation>
    </message>
    <message>
        <source>Go on after stop</source>
        <translation>停止后继续</translation>
    </message>
    <message>
        <source>Start what comes after the stop (M0, M1) at which the machine stands</source>
        <translation>从机床当前停止处 (M0, M1) 之后继续运行</translation>
    </message>
    <message>
        <source>no program was opened</source>
        <translation>未打开程序</translation>
    </message>
    <message>
        <source>Motion programs</source>
        <translation>运动程序</translation>
    </message>
    <message>
        <source>{:.1f} s</source>
        <translation>{:.1f} s</translation>
    </message>
    <message>
        <source>Not sent: there is no way to the start</source>
        <translation>未发送：没有通往起点的路径</translation>
    </message>
    <message>
        <source>The program has {} blocks; block {} comes next</source>
        <translation>程序共有 {} 个程序段；下一个是程序段 {}</translation>
    </message>
    <message>
        <source>Length</source>
        <translation>杆长</translation>
    </message>
    <message>
        <source>Following error</source>
        <translation>跟随误差</translation>
    </message>
    <message>
        <source>State</source>
        <translation>状态</translation>
    </message>
    <message>
        <source>Frame of the large digits, and of lines of G-code</source>
        <translation>大号数字和 G 代码行所用的坐标系</translation>
    </message>
    <message>
        <source>Axis</source>
        <translation>刀轴</translation>
    </message>
    <message>
        <source>Tilt</source>
        <translation>倾角</translation>
    </message>
    <message>
        <source>In the machine frame: {}</source>
        <translation>机床坐标系中：{}</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>是</translation>
    </message>
    <message>
        <source>no</source>
        <translation>否</translation>
    </message>
    <message>
        <source>Hold</source>
        <translation>进给保持</translation>
    </message>
    <message>
        <source>Slow down to rest, on the path</source>
        <translation>沿路径减速至静止</translation>
    </message>
    <message>
        <source>Resume</source>
        <translation>恢复</translation>
    </message>
    <message>
        <source>Go on after a hold</source>
        <translation>进给保持后继续</translation>
    </message>
    <message>
        <source>Abort</source>
        <translation>中止</translation>
    </message>
    <message>
        <source>Hold, then end the program</source>
        <translation>先进给保持，然后结束程序</translation>
    </message>
    <message>
        <source>Abort at once</source>
        <translation>立即中止</translation>
    </message>
    <message>
        <source>Each strut stops as fast as it can: the tool leaves its path</source>
        <translation>各支链以最快方式停止：刀具会偏离路径</translation>
    </message>
    <message>
        <source>Override: how fast time passes in programs</source>
        <translation>倍率：程序中时间推进的快慢</translation>
    </message>
    <message>
        <source>Override</source>
        <translation>倍率</translation>
    </message>
    <message>
        <source>there is no connection</source>
        <translation>没有连接</translation>
    </message>
    <message>
        <source>a Power PMAC can be watched, held and aborted alone</source>
        <translation>Power PMAC 只能监视、进给保持和中止</translation>
    </message>
    <message>
        <source>the controller does not answer</source>
        <translation>控制器没有应答</translation>
    </message>
    <message>
        <source>another order is being carried out</source>
        <translation>正在执行另一指令</translation>
    </message>
    <message>
        <source>the program is not loaded</source>
        <translation>程序尚未下载</translation>
    </message>
    <message>
        <source>a trajectory is played</source>
        <translation>正在播放轨迹</translation>
    </message>
    <message>
        <source>no trajectory is played</source>
        <translation>没有播放轨迹</translation>
    </message>
    <message>
        <source>what is played does not wait</source>
        <translation>播放没有在等待</translation>
    </message>
    <message>
        <source>no block comes next</source>
        <translation>没有下一程序段</translation>
    </message>
    <message>
        <source>the program has no stop with moves after it</source>
        <translation>程序中没有其后仍有运动的停止点</translation>
    </message>
    <message>
        <source>a program runs</source>
        <translation>程序正在运行</translation>
    </message>
    <message>
        <source>a program is held</source>
        <translation>程序处于进给保持</translation>
    </message>
    <message>
        <source>no program is held</source>
        <translation>没有处于进给保持的程序</translation>
    </message>
    <message>
        <source>the machine moves</source>
        <translation>机床正在运动</translation>
    </message>
    <message>
        <source>not all struts are homed</source>
        <translation>并非所有支链都已回零</translation>
    </message>
    <message>
        <source>the struts look for their homes</source>
        <translation>支链正在回零</translation>
    </message>
    <message>
        <source>all struts have found their homes</source>
        <translation>所有支链均已回零</translation>
    </message>
    <message>
        <source>the controller shows no homing</source>
        <translation>控制器未显示回零动作</translation>
    </message>
    <message>
        <source>the homing has failed</source>
        <translation>回零失败</translation>
    </message>
    <message>
        <source>the homing takes too long</source>
        <translation>回零用时过长</translation>
    </message>
    <message>
        <source>on its lower limit</source>
        <translation>到达下极限</translation>
    </message>
    <message>
        <source>on its upper limit</source>
        <translation>到达上极限</translation>
    </message>
    <message>
        <source>stopped on a limit</source>
        <translation>因极限而停止</translation>
    </message>
    <message>
        <source>in open loop</source>
        <translation>处于开环</translation>
    </message>
    <message>
        <source>searching its home</source>
        <translation>正在回零</translation>
    </message>
    <message>
        <source>amplifier fault</source>
        <translation>驱动器故障</translation>
    </message>
    <message>
        <source>following error too large, switched off</source>
        <translation>跟随误差过大，已关断</translation>
    </message>
    <message>
        <source>following error at its warning limit</source>
        <translation>跟随误差达到警告极限</translation>
    </message>
    <message>
        <source>the program ended with an error</source>
        <translation>程序因错误而结束</translation>
    </message>
    <message>
        <source>an amplifier has a fault</source>
        <translation>有驱动器故障</translation>
    </message>
    <message>
        <source>a following error was too large</source>
        <translation>有跟随误差过大</translation>
    </message>
    <message>
        <source>a limit was met</source>
        <translation>碰到极限</translation>
    </message>
    <message>
        <source>THE LINK TO THE CONTROLLER IS LOST AND THE MACHINE MAY BE MOVING. This computer cannot stop it now.</source>
        <translation>与控制器的连接已丢失，机床可能正在运动。本计算机现在无法使其停止。</translation>
    </message>
    <message>
        <source>1. If anything is not as it should be, press the EMERGENCY STOP of the machine. Do not wait for this computer.</source>
        <translation>1. 如有任何异常，立即按下机床的急停按钮。不要等待本计算机。</translation>
    </message>
    <message>
        <source>2. Keep everybody away from the machine. The program goes on in the controller until it ends.</source>
        <translation>2. 让所有人远离机床。程序会在控制器中继续运行直至结束。</translation>
    </message>
    <message>
        <source>3. If the machine has a feed hold of its own, press it, and look that all six struts stand.</source>
        <translation>3. 如果机床自带进给保持按钮，请按下，并确认六条支链全部静止。</translation>
    </message>
    <message>
        <source>4. Then look at the cable, at the power of the controller, and at this computer; leave the machine as it is.</source>
        <translation>4. 然后检查电缆、控制器电源和本计算机；保持机床原状。</translation>
    </message>
    <message>
        <source>5. When the controller answers again: status, then hold, then abort. Do not start, resume, jog or load before.</source>
        <translation>5. 控制器恢复应答后：先查看状态，然后进给保持，再中止。在此之前不要启动、恢复、点动或下载。</translation>
    </message>
    <message>
        <source>6. If the power was off or the emergency stop was pressed: home the machine before anything else.</source>
        <translation>6. 如果曾断电或按过急停：首先使机床回零，然后再进行其他操作。</translation>
    </message>
    <message>
        <source>7. Bring the tool free of the part by short jogs along its axis, then to the start, before a program runs again.</source>
        <translation>7. 再次运行程序之前，先沿刀轴以小步点动使刀具离开工件，然后移至起点。</translation>
    </message>
    <message>
        <source>Nothing was read yet</source>
        <translation>尚未读取任何内容</translation>
    </message>
    <message>
        <source>no program runs</source>
        <translation>没有程序在运行</translation>
    </message>
    <message>
        <source>override {:g} %</source>
        <translation>倍率 {:g} %</translation>
    </message>
    <message>
        <source>block {} of {} comes next, line {}: {}</source>
        <translation>下一个是程序段 {}，共 {} 段，第 {} 行：{}</translation>
    </message>
    <message>
        <source>no home yet: strut {}</source>
        <translation>尚未回零：支链 {}</translation>
    </message>
    <message>
        <source>runs</source>
        <translation>运行中</translation>
    </message>
    <message>
        <source>held</source>
        <translation>已保持</translation>
    </message>
    <message>
        <source>rests</source>
        <translation>静止</translation>
    </message>
    <message>
        <source>no link: the machine comes to rest on the path</source>
        <translation>没有连接：机床在路径上停下</translation>
    </message>
    <message>
        <source>single block</source>
        <translation>单段</translation>
    </message>
    <message>
        <source>override 0</source>
        <translation>倍率 0</translation>
    </message>
    <message>
        <source>hold</source>
        <translation>进给保持</translation>
    </message>
    <message>
        <source>waits: {}</source>
        <translation>等待：{}</translation>
    </message>
    <message>
        <source>line {}</source>
        <translation>第 {} 行</translation>
    </message>
    <message>
        <source>feed {}, {:.0f} % reached</source>
        <translation>进给 {}，达到 {:.0f} %</translation>
    </message>
    <message>
        <source>{}; {} and {} to go</source>
        <translation>{}；剩余 {}，{}</translation>
    </message>
    <message>
        <source>Ended by the operator</source>
        <translation>由操作者结束</translation>
    </message>
    <message>
        <source>Played to the end</source>
        <translation>播放完毕</translation>
    </message>
    <message>
        <source>{:.1f} s of motion</source>
        <translation>运动 {:.1f} 秒</translation>
    </message>
    <message>
        <source>It came to rest {} times because nothing more had come in time</source>
        <translation>因后续数据未及时到达而停下 {} 次</translation>
    </message>
    <message>
        <source>at least</source>
        <translation>至少</translation>
    </message>
    <message>
        <source>at most</source>
        <translation>至多</translation>
    </message>
</context>
<context>
    <name>GaugeTable</name>
    <message>
        <source>No.</source>
        <translation>编号</translation>
    </message>
    <message>
        <source>Number of the tool</source>
        <translation>刀具编号</translation>
    </message>
    <message>
        <source>Tool</source>
        <translation>刀具</translation>
    </message>
    <message>
        <source>Tool controller of the job</source>
        <translation>作业的刀具控制器</translation>
    </message>
    <message>
        <source>Bit</source>
        <translation>刀头</translation>
    </message>
    <message>
        <source>Length of the tool bit alone, to compare. It is no gauge length: part of the bit is in its holder, and the holder counts.</source>
        <translation>仅刀头本身的长度，供比较。它不是刀具长度：刀头有一部分在刀柄内，而且刀柄也计入长度。</translation>
    </message>
    <message>
        <source>Gauge length</source>
        <translation>刀具长度</translation>
    </message>
    <message>
        <source>From the spindle nose to the tip, measured with the tool in its holder</source>
        <translation>从主轴端面到刀尖，刀具装在刀柄中测得</translation>
    </message>
    <message>
        <source>Gauge lengths</source>
        <translation>刀具长度（主轴端面到刀尖）</translation>
    </message>
    <message>
        <source>T{}: {} of --tool-length in More arguments goes before the field.</source>
        <translation>T{}：其他参数中 --tool-length 的 {} 优先于此输入框。</translation>
    </message>
</context>
<context>
    <name>LengthField</name>
    <message>
        <source>unknown</source>
        <translation>未知</translation>
    </message>
</context>
<context>
    <name>PKM_Control</name>
    <message>
        <source>Numerical control</source>
        <translation>数控面板</translation>
    </message>
    <message>
        <source>Operate a machine, or a simulated one: look, home, jog, run programs</source>
        <translation>操作机床或模拟机床：监视、回零、点动、运行程序</translation>
    </message>
</context>
<context>
    <name>PKM_Editor</name>
    <message>
        <source>Program editor</source>
        <translation>程序编辑器</translation>
    </message>
    <message>
        <source>Edit G-code or CL data, with its faults shown while it is typed</source>
        <translation>编辑 G 代码或刀位文件，输入时即提示其中的错误</translation>
    </message>
    <message>
        <source>CUTCOM as the file says</source>
        <translation>CUTCOM：按文件说明</translation>
    </message>
    <message>
        <source>CUTCOM on the tool centre</source>
        <translation>CUTCOM：刀具中心</translation>
    </message>
    <message>
        <source>CUTCOM on the contour</source>
        <translation>CUTCOM：零件轮廓</translation>
    </message>
    <message>
        <source>Open end allowed</source>
        <translation>允许无结束</translation>
    </message>
    <message>
        <source>Flavour as the file says</source>
        <translation>方言：按文件说明</translation>
    </message>
    <message>
        <source>Dwells as the flavour has them</source>
        <translation>暂停时间单位：按方言</translation>
    </message>
    <message>
        <source>Unit as the file says</source>
        <translation>单位：按文件说明</translation>
    </message>
    <message>
        <source>CAM system as the file says</source>
        <translation>CAM 系统：按文件说明</translation>
    </message>
    <message>
        <source>How the G-code says the tool axis</source>
        <translation>G 代码中刀轴的表示方式</translation>
    </message>
    <message>
        <source>Whose G-code it is</source>
        <translation>G 代码的方言</translation>
    </message>
    <message>
        <source>The unit of dwells of the G-code</source>
        <translation>G 代码中暂停时间的单位</translation>
    </message>
    <message>
        <source>The unit of length of the part program</source>
        <translation>零件程序的长度单位</translation>
    </message>
    <message>
        <source>What the points of CL data under CUTCOM are: tool centre or part contour</source>
        <translation>刀位文件中 CUTCOM 下的点是刀具中心还是零件轮廓</translation>
    </message>
    <message>
        <source>The CAM system that wrote the CL data</source>
        <translation>生成刀位文件的 CAM 系统</translation>
    </message>
    <message>
        <source>Take a program that neither M2, M30 or % nor FINI or END-OF-PATH ends</source>
        <translation>接受没有以 M2、M30、% 或 FINI、END-OF-PATH 结束的程序</translation>
    </message>
    <message>
        <source>{} replaced</source>
        <translation>已替换 {} 处</translation>
    </message>
    <message>
        <source>{} blocks, {} arcs, {:.1f} mm</source>
        <translation>{} 个程序段，{} 段圆弧，{:.1f} mm</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>打开</translation>
    </message>
    <message>
        <source>Open a part program</source>
        <translation>打开零件程序</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>保存</translation>
    </message>
    <message>
        <source>Save the part program</source>
        <translation>保存零件程序</translation>
    </message>
    <message>
        <source>Save as</source>
        <translation>另存为</translation>
    </message>
    <message>
        <source>Save under another name</source>
        <translation>以其他名称保存</translation>
    </message>
    <message>
        <source>Find</source>
        <translation>查找</translation>
    </message>
    <message>
        <source>Find and replace</source>
        <translation>查找和替换</translation>
    </message>
    <message>
        <source>Renumber</source>
        <translation>重新编号</translation>
    </message>
    <message>
        <source>Give each block a line number</source>
        <translation>为每个程序段加上行号</translation>
    </message>
    <message>
        <source>Decode</source>
        <translation>解码</translation>
    </message>
    <message>
        <source>Make it an operation of a CAM job</source>
        <translation>使其成为 CAM 作业的一个操作</translation>
    </message>
    <message>
        <source>Post</source>
        <translation>后处理</translation>
    </message>
    <message>
        <source>Write a certified motion program</source>
        <translation>写出经过验证的运动程序</translation>
    </message>
    <message>
        <source>Decode into a job</source>
        <translation>解码到作业中</translation>
    </message>
    <message>
        <source>No CAM job of the active document was chosen.</source>
        <translation>未选择活动文档中的 CAM 作业。</translation>
    </message>
    <message>
        <source>Save the changes of the part program?</source>
        <translation>是否保存对零件程序的更改？</translation>
    </message>
    <message>
        <source>Part programs</source>
        <translation>零件程序</translation>
    </message>
    <message>
        <source>Replace by</source>
        <translation>替换为</translation>
    </message>
    <message>
        <source>Go to the next place</source>
        <translation>转到下一处</translation>
    </message>
    <message>
        <source>Go to the place before</source>
        <translation>转到上一处</translation>
    </message>
    <message>
        <source>Replace what is selected and go to the next place</source>
        <translation>替换所选内容并转到下一处</translation>
    </message>
    <message>
        <source>Replace everywhere, in one step to undo</source>
        <translation>全部替换，可一步撤销</translation>
    </message>
    <message>
        <source>Next</source>
        <translation>下一个</translation>
    </message>
    <message>
        <source>Previous</source>
        <translation>上一个</translation>
    </message>
    <message>
        <source>Replace</source>
        <translation>替换</translation>
    </message>
    <message>
        <source>All</source>
        <translation>全部</translation>
    </message>
    <message>
        <source>Post program</source>
        <translation>后处理程序</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>取消</translation>
    </message>
    <message>
        <source>Stopped. Nothing was written.</source>
        <translation>已停止。未写出任何内容。</translation>
    </message>
    <message>
        <source>Certified and written:</source>
        <translation>已验证并写出：</translation>
    </message>
    <message>
        <source>Open in the editor</source>
        <translation>在编辑器中打开</translation>
    </message>
</context>
<context>
    <name>PKM_InstallPackages</name>
    <message>
        <source>Install packages</source>
        <translation>安装软件包</translation>
    </message>
    <message>
        <source>Install the optional Python packages that are missing here</source>
        <translation>安装此处缺少的可选 Python 软件包</translation>
    </message>
</context>
<context>
    <name>PKM_Machine</name>
    <message>
        <source>Machine</source>
        <translation>机床</translation>
    </message>
    <message>
        <source>Add the machine around the part, with the work offset of the job</source>
        <translation>按作业的工件偏置，在零件周围添加机床</translation>
    </message>
    <message>
        <source>Move it home</source>
        <translation>移到零位</translation>
    </message>
</context>
<context>
    <name>PKM_Mirror</name>
    <message>
        <source>Mirror operation</source>
        <translation>镜像操作</translation>
    </message>
    <message>
        <source>Add the mirror image of the selected operation: plane, climb milling, report</source>
        <translation>添加所选操作的镜像：平面、顺铣、报告</translation>
    </message>
</context>
<context>
    <name>PKM_NormalCompensation</name>
    <message>
        <source>Normal Compensation</source>
        <translation>法向补偿</translation>
    </message>
    <message>
        <source>Take the points of the selected operation for contact points on the model, and let the cutter touch there</source>
        <translation>将所选操作的点作为模型上的接触点，使刀具在这些点接触模型</translation>
    </message>
</context>
<context>
    <name>PKM_Post</name>
    <message>
        <source>Post to a hexapod</source>
        <translation>后处理到六自由度并联机床</translation>
    </message>
    <message>
        <source>Write the certified motion program of the job</source>
        <translation>写出作业经过验证的运动程序</translation>
    </message>
</context>
<context>
    <name>PKM_Reach</name>
    <message>
        <source>Reach</source>
        <translation>可达性</translation>
    </message>
    <message>
        <source>Check whether the machine can follow the job, and colour its way</source>
        <translation>检查机床能否跟随作业，并为其轨迹着色</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>检查项</translation>
    </message>
    <message>
        <source>Least margin</source>
        <translation>最小余量</translation>
    </message>
    <message>
        <source>Proven</source>
        <translation>已证明</translation>
    </message>
    <message>
        <source>Of</source>
        <translation>部件</translation>
    </message>
    <message>
        <source>Worst at</source>
        <translation>最差处</translation>
    </message>
    <message>
        <source>Colour by a check</source>
        <translation>按检查项着色</translation>
    </message>
    <message>
        <source>Colour by the worst check</source>
        <translation>按最差的检查着色</translation>
    </message>
    <message>
        <source>Not checked</source>
        <translation>未检查</translation>
    </message>
    <message>
        <source>The machine can follow the job</source>
        <translation>机床能够跟随该作业</translation>
    </message>
    <message>
        <source>The machine cannot follow the job</source>
        <translation>机床不能跟随该作业</translation>
    </message>
    <message>
        <source>{}, line {}</source>
        <translation>{}，第 {} 行</translation>
    </message>
    <message>
        <source>Open the findings</source>
        <translation>打开检查结果</translation>
    </message>
</context>
<context>
    <name>PKM_Rotate</name>
    <message>
        <source>Rotate operation</source>
        <translation>旋转操作</translation>
    </message>
    <message>
        <source>Add the selected operation turned, once or several times about an axis</source>
        <translation>添加所选操作绕轴线旋转一次或多次的副本</translation>
    </message>
</context>
<context>
    <name>PKM_Simulate</name>
    <message>
        <source>Simulation</source>
        <translation>仿真</translation>
    </message>
    <message>
        <source>CAM&apos;s simulator needs the task panel: close what is open there first</source>
        <translation>CAM 仿真器需要任务面板：请先关闭其中打开的内容</translation>
    </message>
    <message>
        <source>CAM&apos;s simulator does not take this job</source>
        <translation>CAM 仿真器不接受此作业</translation>
    </message>
    <message>
        <source>Simulate</source>
        <translation>仿真</translation>
    </message>
    <message>
        <source>Play the planned motion of the job on its machine</source>
        <translation>在机床上播放作业的规划运动</translation>
    </message>
    <message>
        <source>Pictures</source>
        <translation>图片</translation>
    </message>
    <message>
        <source>{} of {} pictures were written</source>
        <translation>已写出 {} 幅图片，共 {} 幅</translation>
    </message>
    <message>
        <source>Folder for the pictures</source>
        <translation>图片文件夹</translation>
    </message>
    <message>
        <source>Animated PNG</source>
        <translation>PNG 动画</translation>
    </message>
    <message>
        <source>Animated PNG (*.png)</source>
        <translation>PNG 动画 (*.png)</translation>
    </message>
    <message>
        <source>{}, line {}</source>
        <translation>{}，第 {} 行</translation>
    </message>
    <message>
        <source>At this override strut {} would have to do {:.4g} of {:.4g} mm/s</source>
        <translation>在此倍率下，支链 {} 的速度须达 {:.4g} mm/s，而极限为 {:.4g} mm/s</translation>
    </message>
    <message>
        <source>Play and pause</source>
        <translation>播放和暂停</translation>
    </message>
    <message>
        <source>To the beginning of the block</source>
        <translation>到程序段的起点</translation>
    </message>
    <message>
        <source>To the end of the block</source>
        <translation>到程序段的终点</translation>
    </message>
    <message>
        <source>Override</source>
        <translation>倍率</translation>
    </message>
    <message>
        <source>Write the frames as pictures</source>
        <translation>将各帧写为图片</translation>
    </message>
    <message>
        <source>Write an animated PNG</source>
        <translation>写为 PNG 动画</translation>
    </message>
    <message>
        <source>Removal of material, in CAM&apos;s own simulator; it shows every tool upright</source>
        <translation>在 CAM 自带的仿真器中显示材料去除；其中所有刀具均显示为竖直</translation>
    </message>
    <message>
        <source>How many times as fast as the machine</source>
        <translation>相对机床速度的倍数</translation>
    </message>
    <message>
        <source>Feed override: the machine&apos;s own time runs slower or faster</source>
        <translation>进给倍率：机床自身的时间变慢或变快</translation>
    </message>
    <message>
        <source>Stop at problems</source>
        <translation>遇到问题时停止</translation>
    </message>
    <message>
        <source>Problems: {}</source>
        <translation>问题：{}</translation>
    </message>
    <message>
        <source>Operations: {:.1f} s</source>
        <translation>操作：{:.1f} s</translation>
    </message>
    <message>
        <source>Open the player</source>
        <translation>打开播放器</translation>
    </message>
    <message>
        <source>Lengths in mm</source>
        <translation>杆长，mm</translation>
    </message>
    <message>
        <source>Speeds in mm/s</source>
        <translation>速度，mm/s</translation>
    </message>
    <message>
        <source>Readout</source>
        <translation>读数</translation>
    </message>
    <message>
        <source>Program</source>
        <translation>程序</translation>
    </message>
    <message>
        <source>Material</source>
        <translation>材料</translation>
    </message>
    <message>
        <source>View</source>
        <translation>视图</translation>
    </message>
    <message>
        <source>Colour by the distance from the part</source>
        <translation>按与零件的距离着色</translation>
    </message>
    <message>
        <source>No material</source>
        <translation>不显示材料</translation>
    </message>
    <message>
        <source>Material: {}</source>
        <translation>材料：{}</translation>
    </message>
    <message>
        <source>Cutting: {:.1f} of {:.1f} s</source>
        <translation>切削中：{:.1f} / {:.1f} s</translation>
    </message>
    <message>
        <source>Coarse, {}</source>
        <translation>粗，{}</translation>
    </message>
    <message>
        <source>Medium, {}</source>
        <translation>中，{}</translation>
    </message>
    <message>
        <source>Fine, {}</source>
        <translation>细，{}</translation>
    </message>
    <message>
        <source>The job has no stock: choose one in its Setup.</source>
        <translation>作业没有毛坯：请在其“设置”中选择。</translation>
    </message>
    <message>
        <source>The surface of the stock is not closed.</source>
        <translation>毛坯的表面不封闭。</translation>
    </message>
    <message>
        <source>Left over the part: {}, up to {} thick</source>
        <translation>零件上的余量：{}，最厚 {}</translation>
    </message>
    <message>
        <source>Missing of the part: {}, up to {} deep</source>
        <translation>零件缺失：{}，最深 {}</translation>
    </message>
    <message>
        <source>at least {}</source>
        <translation>至少 {}</translation>
    </message>
    <message>
        <source>Strut {}</source>
        <translation>支链 {}</translation>
    </message>
    <message>
        <source>Feed</source>
        <translation>进给</translation>
    </message>
    <message>
        <source>Asked</source>
        <translation>要求</translation>
    </message>
    <message>
        <source>Line</source>
        <translation>行</translation>
    </message>
    <message>
        <source>Left</source>
        <translation>剩余</translation>
    </message>
    <message>
        <source>Shown</source>
        <translation>显示</translation>
    </message>
    <message>
        <source>Transparent</source>
        <translation>透明</translation>
    </message>
    <message>
        <source>Hidden</source>
        <translation>隐藏</translation>
    </message>
    <message>
        <source>Follow the tool</source>
        <translation>跟随刀具</translation>
    </message>
    <message>
        <source>Section plane</source>
        <translation>剖切平面</translation>
    </message>
    <message>
        <source>none</source>
        <translation>无</translation>
    </message>
    <message>
        <source>Tool axis every ... blocks</source>
        <translation>每 … 个程序段显示刀轴</translation>
    </message>
    <message>
        <source>Base</source>
        <translation>底座</translation>
    </message>
    <message>
        <source>Struts</source>
        <translation>支链</translation>
    </message>
    <message>
        <source>Platform and spindle</source>
        <translation>动平台与主轴</translation>
    </message>
    <message>
        <source>Tool</source>
        <translation>刀具</translation>
    </message>
</context>
<context>
    <name>PKM_SurfaceFinish</name>
    <message>
        <source>Surface Finish (5-axis)</source>
        <translation>曲面精加工（五轴）</translation>
    </message>
    <message>
        <source>Cover the selected faces of a job&apos;s model with passes of a leaning tool</source>
        <translation>以倾斜刀具的走刀覆盖作业模型的所选面</translation>
    </message>
    <message>
        <source>Coolant</source>
        <translation>冷却液</translation>
    </message>
    <message>
        <source>Lines</source>
        <translation>走刀线</translation>
    </message>
    <message>
        <source>Order</source>
        <translation>顺序</translation>
    </message>
    <message>
        <source>Cut mode</source>
        <translation>铣削方式</translation>
    </message>
    <message>
        <source>Begin at the other side</source>
        <translation>从另一侧开始</translation>
    </message>
    <message>
        <source>Stepover by</source>
        <translation>行距依据</translation>
    </message>
    <message>
        <source>Distance</source>
        <translation>距离</translation>
    </message>
    <message>
        <source>Scallop height</source>
        <translation>残留高度</translation>
    </message>
    <message>
        <source>Chord tolerance</source>
        <translation>弦高公差</translation>
    </message>
    <message>
        <source>Axis tolerance</source>
        <translation>刀轴公差</translation>
    </message>
    <message>
        <source>Lead</source>
        <translation>前倾角</translation>
    </message>
    <message>
        <source>Tilt</source>
        <translation>侧倾角</translation>
    </message>
    <message>
        <source>Cone limit</source>
        <translation>锥角极限</translation>
    </message>
    <message>
        <source>Approach distance</source>
        <translation>接近距离</translation>
    </message>
    <message>
        <source>Lead-in and lead-out</source>
        <translation>进刀和退刀</translation>
    </message>
    <message>
        <source>Length of leads</source>
        <translation>进退刀长度</translation>
    </message>
    <message>
        <source>Check points, distance</source>
        <translation>检查点间距</translation>
    </message>
    <message>
        <source>None</source>
        <translation>无</translation>
    </message>
    <message>
        <source>Flood</source>
        <translation>浇注</translation>
    </message>
    <message>
        <source>Mist</source>
        <translation>喷雾</translation>
    </message>
    <message>
        <source>Along U</source>
        <translation>沿 U 方向</translation>
    </message>
    <message>
        <source>Along V</source>
        <translation>沿 V 方向</translation>
    </message>
    <message>
        <source>Parallel planes</source>
        <translation>平行平面</translation>
    </message>
    <message>
        <source>Zigzag</source>
        <translation>往复</translation>
    </message>
    <message>
        <source>One way</source>
        <translation>单向</translation>
    </message>
    <message>
        <source>Spiral</source>
        <translation>螺旋</translation>
    </message>
    <message>
        <source>Climb</source>
        <translation>顺铣</translation>
    </message>
    <message>
        <source>Conventional</source>
        <translation>逆铣</translation>
    </message>
    <message>
        <source>As it comes</source>
        <translation>不限</translation>
    </message>
    <message>
        <source>Tangent</source>
        <translation>相切</translation>
    </message>
    <message>
        <source>Arc</source>
        <translation>圆弧</translation>
    </message>
    <message>
        <source>Tool controller</source>
        <translation>刀具控制器</translation>
    </message>
</context>
<context>
    <name>PackageInstall</name>
    <message>
        <source>Install packages</source>
        <translation>安装软件包</translation>
    </message>
    <message>
        <source>G-code and CL data</source>
        <translation>G代码和CL数据</translation>
    </message>
    <message>
        <source>serial lines to a controller</source>
        <translation>连接控制器的串口</translation>
    </message>
    <message>
        <source>ssh to a Power PMAC</source>
        <translation>通过 ssh 连接 Power PMAC</translation>
    </message>
    <message>
        <source>pictures of reports and reach maps</source>
        <translation>报告和可达图的图片</translation>
    </message>
    <message>
        <source>Missing:</source>
        <translation>缺少：</translation>
    </message>
    <message>
        <source>All packages are installed.</source>
        <translation>所有软件包均已安装。</translation>
    </message>
    <message>
        <source>Download and install</source>
        <translation>下载并安装</translation>
    </message>
    <message>
        <source>Install from a folder...</source>
        <translation>从文件夹安装...</translation>
    </message>
    <message>
        <source>Installing packages...</source>
        <translation>正在安装软件包...</translation>
    </message>
</context>
<context>
    <name>PlaceRow</name>
    <message>
        <source>Find a place</source>
        <translation>寻找位置</translation>
    </message>
    <message>
        <source>Look for a work offset, and if need be another spin, at which the machine can follow</source>
        <translation>寻找机床能够跟随的工件偏置，必要时使用另一种自转角</translation>
    </message>
    <message>
        <source>Take this place</source>
        <translation>采用此位置</translation>
    </message>
    <message>
        <source>Set it as --work-offset, and --spin, in the arguments of the job</source>
        <translation>将其作为 --work-offset 和 --spin 写入作业的参数</translation>
    </message>
    <message>
        <source>Looking for a place ...</source>
        <translation>正在寻找位置……</translation>
    </message>
    <message>
        <source>shift {amount} in {axis}</source>
        <translation>沿 {axis} 平移 {amount}</translation>
    </message>
    <message>
        <source>turn {amount} about {axis}</source>
        <translation>绕 {axis} 旋转 {amount}</translation>
    </message>
    <message>
        <source>where it is</source>
        <translation>原位置</translation>
    </message>
    <message>
        <source>spin optimised</source>
        <translation>优化自转角</translation>
    </message>
    <message>
        <source>No place was found. The last one tried: {}; there: {}</source>
        <translation>未找到位置。尝试过的最后一个：{}；在那里：{}</translation>
    </message>
    <message>
        <source>{} to spare</source>
        <translation>余量 {}</translation>
    </message>
    <message>
        <source>{}: the machine can follow, {}</source>
        <translation>{}：机床能够跟随，{}</translation>
    </message>
</context>
<context>
    <name>PostChoices</name>
    <message>
        <source>Shortest rotation from upright</source>
        <translation>从竖直方向的最短旋转</translation>
    </message>
    <message>
        <source>As the part program says</source>
        <translation>按零件程序</translation>
    </message>
    <message>
        <source>x axis in a vertical plane</source>
        <translation>x 轴在竖直平面内</translation>
    </message>
    <message>
        <source>y axis in a vertical plane</source>
        <translation>y 轴在竖直平面内</translation>
    </message>
    <message>
        <source>Most stroke left</source>
        <translation>剩余行程最大</translation>
    </message>
    <message>
        <source>Most swing of the joints left</source>
        <translation>铰链剩余摆角最大</translation>
    </message>
    <message>
        <source>Farthest from singular poses</source>
        <translation>离奇异位姿最远</translation>
    </message>
    <message>
        <source>Most left of all three</source>
        <translation>三者综合余量最大</translation>
    </message>
    <message>
        <source>Table of the strut motion (CSV)</source>
        <translation>支链运动表 (CSV)</translation>
    </message>
    <message>
        <source>Table for LinuxCNC&apos;s halstreamer</source>
        <translation>LinuxCNC halstreamer 用的表</translation>
    </message>
    <message>
        <source>G-code for LinuxCNC&apos;s hexapod, not certified</source>
        <translation>LinuxCNC 六杆机床的 G 代码，未经验证</translation>
    </message>
    <message>
        <source>Picture of the report (PNG)</source>
        <translation>报告图片 (PNG)</translation>
    </message>
    <message>
        <source>Program in X Y Z A B C</source>
        <translation>X Y Z A B C 程序</translation>
    </message>
    <message>
        <source>Machine</source>
        <translation>机床</translation>
    </message>
    <message>
        <source>A name, or a file</source>
        <translation>名称或文件</translation>
    </message>
    <message>
        <source>Work offset</source>
        <translation>工件偏置</translation>
    </message>
    <message>
        <source>Name of a work offset of the machine, or X,Y,Z[,degrees about z] in mm</source>
        <translation>机床的工件偏置名称，或 X,Y,Z[,绕 z 轴的度数]，单位 mm</translation>
    </message>
    <message>
        <source>Tip tolerance</source>
        <translation>刀尖公差</translation>
    </message>
    <message>
        <source>How far the tool tip may be from the programmed path</source>
        <translation>刀尖偏离编程路径的最大允许距离</translation>
    </message>
    <message>
        <source>Axis tolerance</source>
        <translation>刀轴公差</translation>
    </message>
    <message>
        <source>How far the tool axis may be from the programmed axis</source>
        <translation>刀轴偏离编程刀轴的最大允许角度</translation>
    </message>
    <message>
        <source>Spin</source>
        <translation>自转角</translation>
    </message>
    <message>
        <source>How the platform turns about the tool axis</source>
        <translation>动平台绕刀轴转动的方式</translation>
    </message>
    <message>
        <source>Heading</source>
        <translation>朝向</translation>
    </message>
    <message>
        <source>Where the axis of the platform points when the tool is upright</source>
        <translation>刀具竖直时动平台的轴所指的方向</translation>
    </message>
    <message>
        <source>Also write</source>
        <translation>同时写出</translation>
    </message>
    <message>
        <source>What to write beside the program</source>
        <translation>除程序外还要写出的内容</translation>
    </message>
    <message>
        <source>More arguments</source>
        <translation>其他参数</translation>
    </message>
    <message>
        <source>Arguments that have no field here, such as --surface-speed 120, or --tool-length 1=120 for a part program</source>
        <translation>此处没有输入框的参数，例如 --surface-speed 120，或用于零件程序的 --tool-length 1=120</translation>
    </message>
    <message>
        <source>Folder</source>
        <translation>文件夹</translation>
    </message>
    <message>
        <source>Where the files are written</source>
        <translation>文件写出的位置</translation>
    </message>
    <message>
        <source>the fixture of the job</source>
        <translation>作业的工件坐标系</translation>
    </message>
    <message>
        <source>Machine file</source>
        <translation>机床文件</translation>
    </message>
    <message>
        <source>Machine files</source>
        <translation>机床文件</translation>
    </message>
    <message>
        <source>Folder for the files</source>
        <translation>文件所在的文件夹</translation>
    </message>
</context>
<context>
    <name>PostOutcome</name>
    <message>
        <source>Measured</source>
        <translation>测量项</translation>
    </message>
    <message>
        <source>Worst</source>
        <translation>最差值</translation>
    </message>
    <message>
        <source>Limit</source>
        <translation>极限</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>单位</translation>
    </message>
    <message>
        <source>Where</source>
        <translation>位置</translation>
    </message>
    <message>
        <source>Open the report</source>
        <translation>打开报告</translation>
    </message>
    <message>
        <source>Shows the report in the web browser; no network is needed</source>
        <translation>在网页浏览器中显示报告；不需要网络</translation>
    </message>
    <message>
        <source>Refused. Nothing was written.</source>
        <translation>已拒绝。未写出任何内容。</translation>
    </message>
    <message>
        <source>Certified, as far as the lines below say ({} poses computed). {} s at the machine, {} files.</source>
        <translation>已验证，范围如下各行所述（计算了 {} 个位姿）。加工用时 {} 秒，{} 个文件。</translation>
    </message>
    <message>
        <source>{}: not posted</source>
        <translation>{}：未输出</translation>
    </message>
</context>
<context>
    <name>PostPanel</name>
    <message>
        <source>Post to a hexapod</source>
        <translation>后处理到六自由度并联机床</translation>
    </message>
    <message>
        <source>Post</source>
        <translation>后处理</translation>
    </message>
    <message>
        <source>Write the certified motion program and what goes with it</source>
        <translation>写出经过验证的运动程序及其附带文件</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>取消</translation>
    </message>
    <message>
        <source>Open folder</source>
        <translation>打开文件夹</translation>
    </message>
    <message>
        <source>Show the files that were written</source>
        <translation>显示已写出的文件</translation>
    </message>
    <message>
        <source>Simulate</source>
        <translation>仿真</translation>
    </message>
    <message>
        <source>Play the planned motion of the job</source>
        <translation>播放作业的规划运动</translation>
    </message>
    <message>
        <source>Stop after the current step, and write nothing</source>
        <translation>完成当前步骤后停止，不写出任何内容</translation>
    </message>
    <message>
        <source>Stopping after this step</source>
        <translation>此步骤完成后将停止</translation>
    </message>
    <message>
        <source>Stopped. Nothing was written.</source>
        <translation>已停止。未写出任何内容。</translation>
    </message>
    <message>
        <source>An error of the program; the Report view has it.</source>
        <translation>软件出错；详见报告视图。</translation>
    </message>
    <message>
        <source>Keep in the document what is chosen, and post nothing</source>
        <translation>将所选内容保存到文档中，不进行后处理</translation>
    </message>
    <message>
        <source>Kept in the document. Nothing was posted.</source>
        <translation>已保存到文档中。未进行后处理。</translation>
    </message>
    <message>
        <source>Another task panel is open: close it first.</source>
        <translation>另一个任务面板已打开：请先关闭。</translation>
    </message>
</context>
<context>
    <name>PostPreferences</name>
    <message>
        <source>Posting</source>
        <translation>后处理</translation>
    </message>
    <message>
        <source>the folder of the document</source>
        <translation>文档所在的文件夹</translation>
    </message>
    <message>
        <source>What the post panel shows at first for a job that has no arguments of its own.</source>
        <translation>对没有自身参数的作业，后处理面板最初显示的内容。</translation>
    </message>
</context>
<context>
    <name>PostSteps</name>
    <message>
        <source>Reading</source>
        <translation>读取</translation>
    </message>
    <message>
        <source>Trajectory</source>
        <translation>轨迹</translation>
    </message>
    <message>
        <source>Reach and feed plan</source>
        <translation>可达性和进给规划</translation>
    </message>
    <message>
        <source>Collisions</source>
        <translation>碰撞检查</translation>
    </message>
    <message>
        <source>Interpolation</source>
        <translation>插补</translation>
    </message>
    <message>
        <source>Motion program</source>
        <translation>运动程序</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>验证</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>报告</translation>
    </message>
    <message>
        <source>Table of the strut motion</source>
        <translation>支链运动表</translation>
    </message>
    <message>
        <source>Table for halstreamer</source>
        <translation>halstreamer 用的表</translation>
    </message>
    <message>
        <source>G-code for LinuxCNC</source>
        <translation>LinuxCNC 的 G 代码</translation>
    </message>
    <message>
        <source>Program in X Y Z A B C</source>
        <translation>X Y Z A B C 程序</translation>
    </message>
    <message>
        <source>Moving the files to their folder</source>
        <translation>将文件移入文件夹</translation>
    </message>
</context>
<context>
    <name>Progress</name>
    <message>
        <source>Post</source>
        <translation>后处理</translation>
    </message>
    <message>
        <source>{}: stopped at {}</source>
        <translation>{}：停止于 {}</translation>
    </message>
    <message>
        <source>{}: {} done. Escape stops it.</source>
        <translation>{}：已完成 {}。按 Esc 键停止。</translation>
    </message>
    <message>
        <source>{}: gouges</source>
        <translation>{}：过切</translation>
    </message>
</context>
<context>
    <name>SymmetryPanel</name>
    <message>
        <source>As the original tells</source>
        <translation>按原操作</translation>
    </message>
    <message>
        <source>Left of the original&apos;s way</source>
        <translation>原操作走刀方向的左侧</translation>
    </message>
    <message>
        <source>Right of the original&apos;s way</source>
        <translation>原操作走刀方向的右侧</translation>
    </message>
    <message>
        <source>Plane</source>
        <translation>平面</translation>
    </message>
    <message>
        <source>XY</source>
        <translation>XY</translation>
    </message>
    <message>
        <source>XZ</source>
        <translation>XZ</translation>
    </message>
    <message>
        <source>YZ</source>
        <translation>YZ</translation>
    </message>
    <message>
        <source>Pick a flat face or a datum plane</source>
        <translation>拾取平面或基准平面</translation>
    </message>
    <message>
        <source>Axis</source>
        <translation>轴线</translation>
    </message>
    <message>
        <source>X</source>
        <translation>X</translation>
    </message>
    <message>
        <source>Y</source>
        <translation>Y</translation>
    </message>
    <message>
        <source>Z</source>
        <translation>Z</translation>
    </message>
    <message>
        <source>Pick an edge, a round face or a datum line</source>
        <translation>拾取边、回转面或基准线</translation>
    </message>
    <message>
        <source>Edit symmetric operation</source>
        <translation>编辑对称操作</translation>
    </message>
    <message>
        <source>Picked</source>
        <translation>拾取</translation>
    </message>
    <message>
        <source>Typed in</source>
        <translation>输入</translation>
    </message>
    <message>
        <source>Direction</source>
        <translation>方向</translation>
    </message>
    <message>
        <source>Point</source>
        <translation>点</translation>
    </message>
    <message>
        <source>Keep climb milling: run passes the other way</source>
        <translation>保持顺铣：反向走刀</translation>
    </message>
    <message>
        <source>such as 90; 180; 270, in place of the two above</source>
        <translation>例如 90; 180; 270，代替以上两项</translation>
    </message>
    <message>
        <source>Angle</source>
        <translation>角度</translation>
    </message>
    <message>
        <source>Copies</source>
        <translation>副本数</translation>
    </message>
    <message>
        <source>Angles</source>
        <translation>角度列表</translation>
    </message>
    <message>
        <source>Material</source>
        <translation>材料</translation>
    </message>
    <message>
        <source>It depends on this operation</source>
        <translation>它依赖于本操作</translation>
    </message>
    <message>
        <source>climb milling</source>
        <translation>顺铣</translation>
    </message>
    <message>
        <source>conventional milling</source>
        <translation>逆铣</translation>
    </message>
    <message>
        <source>climb and conventional milling</source>
        <translation>顺铣和逆铣</translation>
    </message>
    <message>
        <source>not known</source>
        <translation>未知</translation>
    </message>
    <message>
        <source>Nothing is copied</source>
        <translation>没有复制任何内容</translation>
    </message>
    <message>
        <source>Climb or conventional is not known: say where the material is</source>
        <translation>顺铣或逆铣未知：请说明材料在哪一侧</translation>
    </message>
    <message>
        <source>Original: {}</source>
        <translation>原操作：{}</translation>
    </message>
    <message>
        <source>Copies: {}</source>
        <translation>副本：{}</translation>
    </message>
    <message>
        <source>Passes that are run the other way: {}</source>
        <translation>反向走刀的次数：{}</translation>
    </message>
    <message>
        <source>Arcs that turn the other way: {}</source>
        <translation>反向的圆弧数：{}</translation>
    </message>
    <message>
        <source>Between original and copy: {}</source>
        <translation>原操作与副本之间：{}</translation>
    </message>
    <message>
        <source>Both cut over a width of {}</source>
        <translation>两者都切削的宽度：{}</translation>
    </message>
    <message>
        <source>Original and copies: {}</source>
        <translation>原操作和副本：{}</translation>
    </message>
    <message>
        <source>all round, none on another</source>
        <translation>布满整周，互不重叠</translation>
    </message>
    <message>
        <source>{} covered, {} covered twice, widest gap {}</source>
        <translation>覆盖 {}，重复覆盖 {}，最大间隙 {}</translation>
    </message>
    <message>
        <source>No path of one ends where a path of another begins: the tool is lifted between them. For one continuous path, end the passes of the original at the plane or at the edges of its sector.</source>
        <translation>没有一条轨迹的终点与另一条轨迹的起点相接：其间刀具会抬起。要得到一条连续的轨迹，请让原始操作的各行在平面处或其扇区的边缘处结束。</translation>
    </message>
    <message>
        <source>Where they meet ({}): tips {} apart, tool axes by {}</source>
        <translation>相接处（{} 处）：刀尖相距 {}，刀轴相差 {}</translation>
    </message>
    <message>
        <source>{} with all its copies in the job, {} in number: {}</source>
        <translation>{} 及其在作业中的所有副本，共 {} 个：{}</translation>
    </message>
    <message>
        <source>Edit</source>
        <translation>编辑</translation>
    </message>
</context>
<context>
    <name>Workbench</name>
    <message>
        <source>Post CAM jobs to hexapod machine tools</source>
        <translation>将 CAM 作业后处理到六自由度并联机床</translation>
    </message>
</context>
</TS>
